/* What is copied into a buffer arrives, whether the host can write its memory or not. */
#include "gpu_tests.h"

#define SIZE (((size_t)37 << 20) + 12) /* several pieces on the way, the last one short */

static void upload_and_check(lr_device *device, lr_buffer_kind kind, bool direct, size_t size)
{
    lr_buffer buffer, back;
    uint32_t seed = 7, *bytes = malloc(size);
    assert_non_null(bytes);
    for (size_t i = 0; i < size / sizeof *bytes; i++)
        bytes[i] = random_bits(&seed);
    MUST(lr_buffer_create(device, kind, size, "a test", &buffer, error));
    MUST(lr_buffer_create(device, LR_BUFFER_HOST, size, "a test", &back, error));
    buffer.direct = buffer.direct && direct;
    MUST(lr_buffer_upload(device, &buffer, bytes, size, error));
    MUST(lr_commands_begin(device, error));
    lr_commands_copy(device, &buffer, &back, size);
    MUST(lr_commands_finish(device, error));
    assert_memory_equal(back.mapped, bytes, size);
    free(bytes);
    lr_buffer_destroy(device, &buffer);
    lr_buffer_destroy(device, &back);
}

static void test_upload(void **state)
{
    for (int direct = 0; direct < 2; direct++) {
        upload_and_check(*state, LR_BUFFER_TEXEL, direct, SIZE);
        upload_and_check(*state, LR_BUFFER_STORAGE, direct, 4);
        upload_and_check(*state, LR_BUFFER_UNIFORM, direct, 256);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_upload),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
