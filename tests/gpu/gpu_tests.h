/* Shared by the tests that need a device. Every device is opened with validation, and close_device
 * fails the test when the layer had anything to say. */
#ifndef LR_GPU_TESTS_H
#define LR_GPU_TESTS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu/commands.h"
#include "gpu_layout.h"

/* cmocka 1.1.5 compares floats only. */
#define assert_near(value, expected, tolerance)                                                    \
    do {                                                                                           \
        double value_ = (value), expected_ = (expected);                                           \
        if (!(fabs(value_ - expected_) <= (tolerance)))                                            \
            fail_msg("%s is %.9g, expected %.9g", #value, value_, expected_);                      \
    } while (0)

/* ---- The device ---------------------------------------------------------------------------- */

static inline lr_device *open_device(void)
{
    lr_device *device = NULL;
    lr_error error = {0};
    lr_status status = lr_device_open(&(lr_device_desc){.validation = true}, &device, &error);
    if (status)
        fail_msg("no device: %s", error.message);
    return device;
}

/* Ends the Vulkan device before it counts the messages, so that what was left over is among them.
 */
static inline void close_device(lr_device *device)
{
    lr_device_end(device);
    char text[1024] = "";
    uint32_t messages = lr_device_validation_messages(device, text, sizeof text);
    lr_device_close(device);
    if (messages)
        fail_msg("validation: %s", text);
}

/* A group's setup: the device is *state. */
static inline int setup_device(void **state)
{
    *state = open_device();
    return 0;
}

/* A group's last test. Not its teardown, whose failure cmocka does not count. */
static inline void test_validation_is_silent(void **state)
{
    close_device(*state);
}

/* ---- Kernels ------------------------------------------------------------------------------- */

#define MUST(call)                                                                                 \
    do {                                                                                           \
        lr_error error_ = {0};                                                                     \
        lr_error *error = &error_;                                                                 \
        if ((call))                                                                                \
            fail_msg("%s: %s", #call, error_.message);                                             \
    } while (0)

typedef struct kernel {
    const uint32_t *words;
    size_t word_count;
    const void *in; /* becomes the storage buffer at binding 0 */
    size_t in_size;
    void *out; /* comes from the storage buffer at binding 1 */
    size_t out_size;
    uint32_t which; /* the first word of the push constants */
    uint32_t groups;
} kernel;

static inline void run_kernel(lr_device *device, const kernel *k)
{
    const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    lr_layout_desc layout_desc = {
        .types = types, .binding_count = 2, .push_size = sizeof(struct gpu_work), .set_count = 1};
    lr_program_desc program_desc = {.words = k->words, .word_count = k->word_count};
    struct gpu_work push = {.tile_x = k->which};
    lr_layout layout;
    lr_buffer in, out, back;
    VkPipeline program;
    VkDescriptorSet set;
    const lr_buffer *buffers[] = {&in, &out};
    MUST(lr_layout_create(device, &layout_desc, &layout, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, k->in_size, "in", &in, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, k->out_size, "out", &out, error));
    MUST(lr_buffer_create(device, LR_BUFFER_HOST, k->out_size, "back", &back, error));
    MUST(lr_set_create(device, &layout, buffers, &set, error));
    MUST(lr_program_create(device, &layout, &program_desc, &program, error));
    MUST(lr_buffer_upload(device, &in, k->in, k->in_size, error));
    MUST(lr_commands_begin(device, error));
    lr_commands_dispatch(device, &layout, program, set, &push, k->groups, 1, 1);
    lr_commands_barrier(device);
    lr_commands_copy(device, &out, &back, k->out_size);
    MUST(lr_commands_finish(device, error));
    memcpy(k->out, back.mapped, k->out_size);
    device->vk.vkDestroyPipeline(device->handle, program, NULL);
    lr_layout_destroy(device, &layout);
    lr_buffer_destroy(device, &in);
    lr_buffer_destroy(device, &out);
    lr_buffer_destroy(device, &back);
}

/* ---- Random numbers ------------------------------------------------------------------------ */

static inline uint32_t random_bits(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (word >> 22) ^ word;
}

static inline float random_between(uint32_t *state, double low, double high)
{
    return (float)(low + (high - low) * (random_bits(state) / 4294967296.0));
}

/* A positive float whose exponent is equally likely to be any of low..high. */
static inline float random_magnitude(uint32_t *state, int low, int high)
{
    float mantissa = 1 + (float)(random_bits(state) >> 9) * 1.1920928955078125e-7f;
    return ldexpf(mantissa, low + (int)(random_bits(state) % (uint32_t)(high - low + 1)));
}

static inline float random_sign(uint32_t *state)
{
    return random_bits(state) & 1u ? -1.0f : 1.0f;
}

/* The distance between floats at this value. */
static inline double ulp_of(double value)
{
    int exponent;
    frexp(value, &exponent);
    return ldexp(1, exponent - 24);
}

static inline uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* ---- Scenes -------------------------------------------------------------------------------- */

typedef struct picture {
    lr_picture image;
    lr_render_stats stats;
} picture;

static inline void free_picture(picture *p)
{
    lr_picture_free(&p->image);
}

/* The mean of a channel over the whole picture. */
static inline double mean_of(const picture *p, int channel)
{
    double sum = 0;
    size_t count = (size_t)p->image.width * p->image.height;
    for (size_t i = 0; i < count; i++)
        sum += p->image.pixels[3 * i + (size_t)channel];
    return sum / (double)count;
}

/* How far the sample lies from the value that does most. */
static inline double worst_distance_from(const picture *p, double value)
{
    double worst = 0;
    for (size_t i = 0; i < 3 * (size_t)p->image.width * p->image.height; i++)
        worst = fmax(worst, fabs(p->image.pixels[i] - value));
    return worst;
}

static inline bool same_pictures(const picture *a, const picture *b)
{
    size_t count = 3 * (size_t)a->image.width * a->image.height;
    return memcmp(a->image.pixels, b->image.pixels, count * sizeof(float)) == 0;
}

/* Parses the text, which must be a scene, and renders it with options (may be NULL). */
static inline picture render_text(lr_device *device, const char *text,
                                  const lr_render_options *options)
{
    picture result;
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    if (lr_scene_parse(text, strlen(text), "test.yaml", &scene, &report, &error))
        fail_msg("%s\n%s\n%s", error.message, report ? report : "", text);
    if (lr_render(device, scene, options, &result.image, &result.stats, &error))
        fail_msg("%s\n%s", error.message, text);
    lr_scene_destroy(scene);
    return result;
}

typedef struct rgb {
    double r, g, b;
} rgb;

static inline rgb pixel_at(const picture *p, uint32_t x, uint32_t y)
{
    const float *at = &p->image.pixels[3 * ((size_t)y * p->image.width + x)];
    return (rgb){at[0], at[1], at[2]};
}

/* The one pixel of a scene text made with printf; stats may be NULL. */
__attribute__((format(printf, 3, 4))) static inline rgb
render_pixel(lr_device *device, lr_render_stats *stats, const char *format, ...)
{
    char text[8192];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_in_range(length, 1, sizeof text - 1);
    picture p = render_text(device, text, &(lr_render_options){.width = 1, .height = 1});
    rgb result = pixel_at(&p, 0, 0);
    if (stats)
        *stats = p.stats;
    free_picture(&p);
    return result;
}

#endif
