#include "cli/self_test.h"

#include "cli/cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CAMERA "camera: {from: [0, 1.5, 6], to: [0, 1, 0], fov: 40}\n"

typedef struct test_scene {
    const char *name;
    const char *text;
} test_scene;

/* Each goes where a driver's freedom in arithmetic would show. */
static const test_scene scenes[] = {
    {"spheres", "lavaray: 1\n" CAMERA "image: {width: 64, height: 48, samples: 4, depth: 6}\n"
                "lights: [{point: {position: [4, 6, 3], intensity: 60, falloff: 2}}]\n"
                "objects:\n"
                "  - sphere: {center: [0, 1, 0], radius: 1, material: {color: '#c04020', "
                "specular: 0.5, shininess: 37.5}}\n"
                "  - sphere: {center: [-1.7, 0.7, -0.4], radius: 0.7, material: {diffuse: 0, "
                "reflect: 0.9}}\n"
                "  - sphere: {center: [1.6, 0.6, 0.5], radius: 0.6, material: {color: [0.2, 0.5, "
                "0.9], reflect: 0.3}}\n"
                "  - sphere: {center: [0, -1000, 0], radius: 1000}\n"},
    {"checkers", "lavaray: 1\n" CAMERA "image: {width: 64, height: 48, samples: 4, depth: 4}\n"
                 "materials:\n"
                 "  floor: {color: {checker: [white, black], size: 1}}\n"
                 "lights: [{point: {position: [4, 6, 3], intensity: 60, falloff: 2}}]\n"
                 "objects:\n"
                 "  - plane: {normal: [0, 1, 0], offset: 0, material: floor}\n"
                 "  - plane: {normal: [1, 0, 0], offset: -3, material: floor}\n"
                 "  - plane: {normal: [0, 0, 1], offset: -7, material: floor}\n"
                 "  - sphere: {center: [0, 1, 0], radius: 1, material: {color: {checker: [red, "
                 "white], size: 0.5}}}\n"},
    {"glass", "lavaray: 1\n" CAMERA "image: {width: 64, height: 48, samples: 4, depth: 12}\n"
              "materials:\n"
              "  glass: {diffuse: 0, transmit: 1, ior: 1.5, fresnel: true, absorption: [0.6, 0.2, "
              "0.1]}\n"
              "  water: {diffuse: 0, transmit: 1, ior: 1.33, priority: -1}\n"
              "lights: [{point: {position: [4, 6, 3], intensity: 60, falloff: 2}}]\n"
              "objects:\n"
              "  - sphere: {center: [0, 1, 0], radius: 1, material: glass}\n"
              "  - sphere: {center: [0.3, 1, 0.2], radius: 0.5, material: water}\n"
              "  - sphere: {center: [1.2, 0.8, 0.3], radius: 0.8, material: water}\n"
              "  - plane: {normal: [0, 1, 0], offset: 0, material: {color: {checker: [white, "
              "gray], size: 0.5}}}\n"},
    {"faint", "lavaray: 1\n" CAMERA "image: {width: 64, height: 48, samples: 4, depth: 6}\n"
              "ambient: 1e-30\n"
              "background: [1e-30, 1e-38, 1e-7]\n"
              "lights: [{point: {position: [4, 6, 3], intensity: 1e-9, falloff: 2}}]\n"
              "objects:\n"
              "  - sphere: {center: [0, 1, 0], radius: 1, material: {color: [1e-30, 1, 1e-20], "
              "reflect: 1e-12}}\n"
              "  - sphere: {center: [1.6, 0.6, 0.5], radius: 0.6, material: {color: 1e-30}}\n"
              "  - plane: {normal: [0, 1, 0], offset: 0, material: {color: 1e-6, reflect: 0.5}}\n"},
    {"tiny", "lavaray: 1\n"
             "camera: {from: [0, 0, 1e-19], to: [0, 0, 0], fov: 40}\n"
             "image: {width: 64, height: 48, samples: 4, depth: 4}\n"
             "lights: [{directional: {direction: [-1, -2, -3]}}]\n"
             "objects:\n"
             "  - sphere: {center: [0, 0, 0], radius: 1e-20, material: {color: orange}}\n"
             "  - sphere: {center: [1.5e-20, 1e-20, 0], radius: 1e-20, material: {diffuse: 0.2, "
             "reflect: 0.7}}\n"},
    {"lights", "lavaray: 1\n" CAMERA "image: {width: 64, height: 48, samples: 4, depth: 4}\n"
               "lights:\n"
               "  - spot: {position: [-2, 4, 2], direction: [1, -2, -1], angle: 30, inner: 11.5, "
               "intensity: 9, falloff: 1.37}\n"
               "  - point: {position: [3, 3, 3], color: [1, 0.3, 0.1], intensity: 2, falloff: "
               "0.5}\n"
               "  - point: {position: [0, 5, 0], color: [0.1, 0.3, 1], intensity: 40, falloff: "
               "3.1}\n"
               "objects:\n"
               "  - sphere: {center: [0, 1, 0], radius: 1, material: {specular: 0.4, shininess: "
               "1000}}\n"
               "  - plane: {normal: [0, 1, 0], offset: 0}\n"},
    {"shapes", "lavaray: 1\n" CAMERA "image: {width: 64, height: 48, samples: 4, depth: 5}\n"
               "lights: [{point: {position: [4, 6, 3], intensity: 60, falloff: 2}}]\n"
               "objects:\n"
               "  - box: {min: [-0.5, -0.5, -0.5], max: [0.5, 0.5, 0.5], rotate: {axis: [1, 1, "
               "0], angle: 33}, translate: [-1.2, 1, 0], material: {color: teal, reflect: "
               "0.2}}\n"
               "  - cone: {from: [0, 0, 0], to: [0, 1, 0], radius: 0.6, scale: [1, 2, 1], rotate: "
               "[5, 0, -10], translate: [0.5, 0, -0.5]}\n"
               "  - cylinder: {from: [1.5, 0, 0], to: [1.8, 1.4, 0.3], radius: 0.3, material: "
               "{diffuse: 0.1, reflect: 0.8}}\n"
               "  - triangle: {a: [-2, 0, -1], b: [2, 0, -1.5], c: [0, 3, -2]}\n"
               "  - disk: {center: [-1.5, 0.01, 1.5], radius: 0.5, material: {color: red}}\n"
               "  - plane: {normal: [0, 1, 0], offset: 0}\n"},
};
enum { SCENE_COUNT = sizeof scenes / sizeof *scenes };

/* The hashes that every exact device has, in the order of the scenes. A change here is a change of
 * what all pictures look like, and goes into the change log. An empty one is not settled yet. */
static const char *const expected[SCENE_COUNT] = {
    "b771ec12e3a58d5a3a726ff87b1f940da9e67ae40a0f0f639b5688dad377d145", /* spheres */
    "7a286bb23ce1ba796fd06e88df0ef53309da3baa6083bd767639ee62db281166", /* checkers */
    "87ef6d0832a5541bb9b6a0b790d660e3e359733f850651ca92ee7a1920511d86", /* glass */
    "7d3f3bbd8d9c51a3f5b73b2d390e43b68b73da832d644964d2ad4b146a16a328", /* faint */
    "8dc7789618aef600fb10f67856ed6bad4a235c9b8f6396fa9c628b479d0625a1", /* tiny */
    "93c8666d663aac58411eeed7664d431f0b4d292c1a25e3330effa7848291791f", /* lights */
    "da19bcec533bc29930ee39808fd60007e1d133f3beebba266ddaa3b83b330e79", /* shapes */
};

/* Renders one scene; false after printing why it cannot be. */
static bool render_scene(lr_device *device, const test_scene *test, char hash[65], int *code)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    lr_status status =
        lr_scene_parse(test->text, strlen(test->text), test->name, &scene, &report, &error);
    if (status != LR_OK) {
        print_error("built-in scene %s: %s", test->name, report ? report : error.message);
        free(report);
        *code = EXIT_DEVICE;
        return false;
    }
    lr_picture picture = {0};
    lr_render_options render_options = {0};
    lr_render_stats stats;
    status = lr_render(device, scene, &render_options, &picture, &stats, &error);
    lr_scene_destroy(scene);
    if (status != LR_OK) {
        error.status = status;
        *code = report_failure(&error);
        return false;
    }
    lr_picture_hash(&picture, hash);
    lr_picture_free(&picture);
    return true;
}

static void print_row(const lr_device_info *info, bool exact, char hashes[][65], int same)
{
    printf("\nFor docs/exact.md:\n| %s | %s | %s | %s | %s | %d of %d |", info->name, info->driver,
           format_version(info->api_version).text, info->software ? "software" : "GPU",
           exact ? "passes" : "fails", same, (int)SCENE_COUNT);
    for (int i = 0; i < SCENE_COUNT; i++) {
        printf(" `%.12s`", hashes[i]);
    }
    printf(" |\n");
}

int run_self_test(uint32_t device_index)
{
    char select[16];
    snprintf(select, sizeof select, "%u", (unsigned)device_index);
    lr_device_desc desc = {.select = select, .validation = validation_wanted()};
    lr_device *device = NULL;
    lr_error error = {0};
    lr_status status = lr_device_open(&desc, &device, &error);
    if (status != LR_OK) {
        error.status = status;
        return report_failure(&error);
    }
    const lr_device_info *info = lr_device_get_info(device);
    int code = EXIT_FINE, same = 0;
    char hashes[SCENE_COUNT][65];
    printf("\nSelf-test of device %s, %s\n", select, info->name);
    for (int i = 0; i < SCENE_COUNT; i++) {
        if (!render_scene(device, &scenes[i], hashes[i], &code)) {
            goto done;
        }
        bool known = expected[i][0] != '\0', equal = strcmp(expected[i], hashes[i]) == 0;
        printf("  %-10s %s %s\n", scenes[i].name, hashes[i],
               !known  ? "new"
               : equal ? "same"
                       : "DIFFERS");
        fflush(stdout);
        same += known && equal;
        if (known && !equal) {
            code = EXIT_DIFFERENT;
        }
    }
    print_row(info, lr_device_is_exact(device), hashes, same);
    code = check_validation(device, code);
done:
    lr_device_close(device);
    return code;
}
