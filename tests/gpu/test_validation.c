/* Mistakes against Vulkan are seen: what the other tests rest on when they find no message. */
#include "gpu_tests.h"

static void expect_message(lr_device *device, const char *fragment)
{
    char text[1024] = "";
    assert_true(lr_device_validation_messages(device, text, sizeof text) > 0);
    if (!strstr(text, fragment))
        fail_msg("expected %s in: %s", fragment, text);
    lr_device_close(device);
}

static void test_no_mistake_no_message(void **state)
{
    (void)state;
    close_device(open_device());
}

static void test_copy_past_the_end(void **state)
{
    (void)state;
    lr_device *device = open_device();
    lr_buffer small, large;
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, 256, "small", &small, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, 4096, "large", &large, error));
    MUST(lr_commands_begin(device, error));
    /* Recorded, but never run: the layer sees it, the driver does not. */
    lr_commands_copy(device, &large, &small, 4096);
    device->vk.vkEndCommandBuffer(device->commands);
    lr_buffer_destroy(device, &small);
    lr_buffer_destroy(device, &large);
    expect_message(device, "vkCmdCopyBuffer");
}

/* Two writes of the same bytes without a barrier between them. */
static void test_missing_barrier(void **state)
{
    (void)state;
    lr_device *device = open_device();
    lr_buffer buffer, other;
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, 256, "a buffer", &buffer, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, 256, "another", &other, error));
    MUST(lr_commands_begin(device, error));
    lr_commands_zero(device, &buffer, 256);
    lr_commands_copy(device, &buffer, &other, 256);
    MUST(lr_commands_finish(device, error));
    lr_buffer_destroy(device, &buffer);
    lr_buffer_destroy(device, &other);
    expect_message(device, "SYNC-HAZARD");
}

/* A device without validation counts nothing. */
static void test_without_validation(void **state)
{
    (void)state;
    lr_device *device;
    lr_buffer buffer, other;
    MUST(lr_device_open(&(lr_device_desc){0}, &device, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, 256, "a buffer", &buffer, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, 256, "another", &other, error));
    MUST(lr_commands_begin(device, error));
    lr_commands_zero(device, &buffer, 256);
    lr_commands_copy(device, &buffer, &other, 256);
    MUST(lr_commands_finish(device, error));
    lr_buffer_destroy(device, &buffer);
    lr_buffer_destroy(device, &other);
    close_device(device);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_mistake_no_message),
        cmocka_unit_test(test_copy_past_the_end),
        cmocka_unit_test(test_missing_barrier),
        cmocka_unit_test(test_without_validation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
