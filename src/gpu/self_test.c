#include "gpu/self_test.h"

#include <math.h>
#include <string.h>

#include "gpu/commands.h"
#include "gpu_layout.h"
#include "self_test.spv.h"

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (word >> 22) ^ word;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* A float of either sign with an exponent in -12..12, so that no operation below leaves the normal
 * range; a few have short significands, so that sums are exact or ties. */
static float random_float(uint32_t *state)
{
    uint32_t sign_and_fraction = next_random(state) & 0x807FFFFFu;
    uint32_t exponent = 127 - 12 + next_random(state) % 25;
    if (next_random(state) % 4 == 0)
        sign_and_fraction &= 0x807FF000u;
    uint32_t bits = sign_and_fraction | exponent << 23;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Compiled with -ffp-contract=off, so each operation rounds on its own. */
static void expect(const struct gpu_self_test_in *in, struct gpu_self_test_out *out)
{
    float product = in->a * in->b;
    float scaled = in->b * in->c;
    *out = (struct gpu_self_test_out){
        .sum = bits_of(in->a + in->b),
        .difference = bits_of(in->a - in->b),
        .product = bits_of(product),
        .product_sum = bits_of(product + in->c),
        .sum_product = bits_of(in->c - product),
        .scaled = bits_of(scaled + in->c),
        .from_integer = bits_of((float)(in->n & 0x00FFFFFFu)),
        .to_integer = (uint32_t)(int32_t)floorf(in->a * 1024.0f),
    };
}

lr_status lr_self_test(lr_device *device, bool *exact, lr_error *error)
{
    struct gpu_self_test_in given[LR_SELF_TEST_COUNT];
    struct gpu_self_test_out expected[LR_SELF_TEST_COUNT];
    uint32_t state = 1;
    for (uint32_t i = 0; i < LR_SELF_TEST_COUNT; i++) {
        given[i] = (struct gpu_self_test_in){random_float(&state), random_float(&state),
                                             random_float(&state), next_random(&state)};
        expect(&given[i], &expected[i]);
    }

    *exact = false;
    const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    lr_layout_desc layout_desc = {.types = types, .binding_count = 2, .set_count = 1};
    lr_program_desc program_desc = {.words = self_test_spv,
                                    .word_count = sizeof self_test_spv / sizeof *self_test_spv};
    lr_layout layout = {0};
    lr_buffer in = {0}, out = {0}, back = {0};
    VkPipeline program = VK_NULL_HANDLE;
    VkDescriptorSet set;
    const lr_buffer *buffers[] = {&in, &out};
    const char *what = "the self-test";
    lr_status status = lr_layout_create(device, &layout_desc, &layout, error);
    if (!status)
        status = lr_buffer_create(device, LR_BUFFER_STORAGE, sizeof given, what, &in, error);
    if (!status)
        status = lr_buffer_create(device, LR_BUFFER_STORAGE, sizeof expected, what, &out, error);
    if (!status)
        status = lr_buffer_create(device, LR_BUFFER_HOST, sizeof expected, what, &back, error);
    if (!status)
        status = lr_set_create(device, &layout, buffers, &set, error);
    if (!status)
        status = lr_program_create(device, &layout, &program_desc, &program, error);
    if (!status)
        status = lr_commands_begin(device, error);
    if (!status) {
        lr_commands_write(device, &in, 0, given, sizeof given);
        lr_commands_barrier(device);
        lr_commands_dispatch(device, &layout, program, set, NULL,
                             LR_SELF_TEST_COUNT / LR_GROUP_SIZE, 1, 1);
        lr_commands_barrier(device);
        lr_commands_copy(device, &out, &back, sizeof expected);
        status = lr_commands_finish(device, error);
    }
    if (!status)
        *exact = !memcmp(back.mapped, expected, sizeof expected);
    if (program)
        device->vk.vkDestroyPipeline(device->handle, program, NULL);
    lr_layout_destroy(device, &layout);
    lr_buffer_destroy(device, &in);
    lr_buffer_destroy(device, &out);
    lr_buffer_destroy(device, &back);
    return status;
}
