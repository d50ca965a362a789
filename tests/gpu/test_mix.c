/* Mixes of materials on paths: a mean of what its parts show. */
#include "gpu_tests.h"

/* A ball on a floor, in light from everywhere and a lamp, with these two materials to choose from;
 * a picture of what has the material `shown`. */
static picture render_ball(lr_device *device, const char *materials, const char *shown, int depth,
                           int samples)
{
    char scene[2048];
    int length = snprintf(scene, sizeof scene,
                          "camera: {from: [0, 1, 4], to: [0, 0.2, 0], fov: 32}\n"
                          "image: {width: 32, height: 32, samples: %d, depth: %d, integrator: "
                          "path}\n"
                          "background: {gradient: [[0.2, 0.3, 0.3], [0.9, 0.6, 0.4]]}\n"
                          "materials: {%s}\n"
                          "lights: []\n"
                          "objects:\n"
                          "  - sphere: {material: %s}\n"
                          "  - disk: {center: [3, 3, 3], normal: [-1, -1, -1], radius: 0.5, "
                          "material: {diffuse: 0, emission: 8, emits: front}}\n",
                          samples, depth, materials, shown);
    assert_in_range(length, 1, sizeof scene - 1);
    return render_text(device, scene, NULL);
}

static const char *const parts[][2] = {
    {"{color: [0.8, 0.2, 0.1]}", "{model: conductor, metal: gold, roughness: 0.4}"},
    {"{model: pbr, color: [0.2, 0.4, 0.9], roughness: 0.3, clearcoat: 1}",
     "{model: dielectric, ior: 1.4, roughness: 0.5}"},
    {"{model: dielectric, transmit: [1, 0.7, 0.5]}",
     "{diffuse: 0.2, reflect: 0.7, fresnel: true, ior: 2}"},
    {"{model: thin_glass, ior: 1.8}", "{model: diffuse, color: [0, 1, 0.3], roughness: 0.8}"},
    {"{model: pbr, transmission: 0.6, color: [0.9, 0.8, 0.7]}", "{diffuse: 0.5, specular: 0.4}"},
};

/* With direct light alone a picture of a convex body is linear in what the body is made of. */
static void test_mean_of_the_parts(void **state)
{
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        char materials[600];
        snprintf(materials, sizeof materials,
                 "m: {model: mix, first: a, second: b, weight: 0.3}, a: %s, b: %s", parts[i][0],
                 parts[i][1]);
        picture mixed = render_ball(*state, materials, "m", 0, 1024);
        picture first = render_ball(*state, materials, "a", 0, 1024);
        picture second = render_ball(*state, materials, "b", 0, 1024);
        for (int c = 0; c < 3; c++) {
            double expected = 0.7 * mean_of(&first, c) + 0.3 * mean_of(&second, c);
            if (!(fabs(mean_of(&mixed, c) - expected) <= 0.002 * expected))
                fail_msg("%s and %s: mean %g, expected %g", parts[i][0], parts[i][1],
                         mean_of(&mixed, c), expected);
        }
        free_picture(&mixed);
        free_picture(&first);
        free_picture(&second);
    }
}

/* Where the weight leaves no choice, the bytes are the part's. */
static void test_nothing_to_choose(void **state)
{
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        for (int second = 0; second < 2; second++) {
            char materials[600];
            snprintf(materials, sizeof materials,
                     "m: {model: mix, first: a, second: b, weight: %d}, a: %s, b: %s", second,
                     parts[i][0], parts[i][1]);
            picture mixed = render_ball(*state, materials, "m", 4, 16);
            picture alone = render_ball(*state, materials, second ? "b" : "a", 4, 16);
            if (!same_pictures(&mixed, &alone))
                fail_msg("%s: the pictures differ", parts[i][second]);
            free_picture(&mixed);
            free_picture(&alone);
        }
}

/* A pattern of weights 0 and 1 is the pattern of the parts' colours, also in a mix of mixes. */
static void test_patterns(void **state)
{
    static const char *const patterns[] = {
        "checker: [%s, %s], size: 0.3",
        "stripes: [%s, %s], size: 0.2, direction: [1, 2, 0], space: object",
        "rings: [%s, %s], size: 0.15, axis: [1, 0, 1]",
    };
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        char materials[600], weight[128], color[128];
        snprintf(weight, sizeof weight, patterns[i], "0", "1");
        snprintf(color, sizeof color, patterns[i], "red", "blue");
        snprintf(materials, sizeof materials,
                 "m: {model: mix, first: n, second: {color: blue}, weight: {%s}}, "
                 "n: {model: mix, first: {color: green}, second: {color: red}, weight: 1}, "
                 "c: {color: {%s}}",
                 weight, color);
        picture mixed = render_ball(*state, materials, "m", 2, 16);
        picture colored = render_ball(*state, materials, "c", 2, 16);
        if (!same_pictures(&mixed, &colored))
            fail_msg("%s: the pictures differ", patterns[i]);
        free_picture(&mixed);
        free_picture(&colored);
    }
}

/* A picture of one texel: 0.3, as floats are what they are. */
static void write_weight(const char *path)
{
    static const float texel[] = {0.3F, 0.3F, 0.3F};
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("PF\n1 1\n-1.0\n", file);
    fwrite(texel, sizeof texel, 1, file);
    assert_int_equal(fclose(file), 0);
}

/* A wall in the same light from everywhere shows the parts' colours in the shares of the weights,
 * whose luminance counts. */
static void test_shares(void **state)
{
    static const struct {
        const char *material;
        double expected[3];
    } cases[] = {
        {"{model: mix, first: r, second: b, weight: 0.25}", {0.625, 0.1, 0.275}},
        {"{model: mix, first: r, second: b}", {0.45, 0.1, 0.45}},
        {"{model: mix, first: r, second: b, weight: [0, 0.5, 0]}",
         {0.8 - 0.7 * 0.3576, 0.1, 0.1 + 0.7 * 0.3576}},
        {"{model: mix, first: r, second: b, weight: {checker: [0.2, 0.6], size: 0.01}}",
         {0.8 - 0.7 * 0.4, 0.1, 0.1 + 0.7 * 0.4}},
        {"{model: mix, first: r, second: b, weight: {image: test_mix.pfm, tint: 2}}",
         {0.8 - 0.7 * 0.6, 0.1, 0.1 + 0.7 * 0.6}},
        /* 0.5 of r, 0.25 of each of b and of g */
        {"{model: mix, first: r, second: {model: mix, first: b, second: g}}",
         {0.5 * 0.8 + 0.5 * 0.1, 0.75 * 0.1 + 0.25 * 0.8, 0.75 * 0.1 + 0.25 * 0.8}},
        {"{model: mix, weight: 0.125, second: r, first: {model: mix, first: {model: mix, first: "
         "{model: mix, first: b, second: r}, second: g}, second: r}}",
         {0.125 * 0.8 + 0.875 * (0.5 * 0.8 + 0.25 * 0.1 + 0.125 * 0.1 + 0.125 * 0.8),
          0.125 * 0.1 + 0.875 * (0.5 * 0.1 + 0.25 * 0.8 + 0.25 * 0.1),
          0.125 * 0.1 + 0.875 * (0.75 * 0.1 + 0.125 * 0.8 + 0.125 * 0.1)}},
    };
    write_weight("test_mix.pfm");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char scene[1024];
        snprintf(scene, sizeof scene,
                 "camera: {from: [0, 0, 1], to: [0, 0, 0], fov: 20}\n"
                 "image: {width: 64, height: 64, samples: 64, depth: 0, integrator: path}\n"
                 "background: 1\nlights: []\nmaterials:\n"
                 "  r: {color: [0.8, 0.1, 0.1]}\n  g: {color: [0.1, 0.8, 0.1]}\n"
                 "  b: {color: [0.1, 0.1, 0.8]}\n"
                 "objects:\n  - rectangle: {corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], "
                 "material: %s}\n",
                 cases[i].material);
        picture p = render_text(*state, scene, NULL);
        for (int c = 0; c < 3; c++)
            assert_near(mean_of(&p, c), cases[i].expected[c], 0.002);
        free_picture(&p);
    }
    remove("test_mix.pfm");
}

/* What reflects or lets through all light cannot be seen, and no more can its mixes. */
static void test_white_furnace(void **state)
{
    static const struct {
        const char *material;
        double tolerance; /* of a sample */
    } cases[] = {
        {"{model: mix, first: {color: 1}, second: {diffuse: 0, reflect: 1}}", 2e-6},
        {"{model: mix, first: {color: 1}, second: {diffuse: 0, transmit: 1, ior: 1.33}}", 1e-5},
        {"{model: mix, first: {model: thin_glass, ior: 1}, second: {color: 1}}", 1e-5},
        {"{model: mix, first: {diffuse: 0, transmit: 1, ior: 1.2}, second: {model: mix, first: "
         "{color: 1}, second: {diffuse: 0, reflect: 1}}, weight: 0.7}",
         1e-5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char scene[700];
        snprintf(scene, sizeof scene,
                 "camera: {from: [0, 0, 4], to: [0, 0, 0]}\n"
                 "image: {width: 32, height: 32, samples: 16, depth: 64, integrator: path}\n"
                 "background: 1\nlights: []\nobjects:\n  - sphere: {material: %s}\n",
                 cases[i].material);
        picture p = render_text(*state, scene, NULL);
        double worst = worst_distance_from(&p, 1);
        if (!(worst <= cases[i].tolerance))
            fail_msg("%s: off by %g", cases[i].material, worst);
        free_picture(&p);
    }
}

/* The whole mix shines, and its medium absorbs: 8 exp(-0.5 * 2) comes through the middle of a ball
 * of clear index 1, and the ball's own light is there whichever part shows. */
static void test_light_and_medium_of_the_whole(void **state)
{
    rgb through = render_pixel(*state, NULL,
                               "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 0.01}\n"
                               "image: {samples: 256, depth: 8, integrator: path}\n"
                               "background: 8\nlights: []\nobjects:\n"
                               "  - sphere: {material: {model: mix, emission: 0.5, first: "
                               "{model: dielectric, ior: 1, absorption: 0.5}, second: "
                               "{model: dielectric, ior: 1, absorption: 0.5, transmit: 0.5}}}\n");
    /* Light passes two surfaces, each with the mean 0.75 of the parts; their own light is dimmed by
     * what lies before it. */
    double expected = 8 * exp(-1) * 0.75 * 0.75 + 0.5 + 0.5 * exp(-1) * 0.75;
    assert_near(through.r, expected, 0.02 * expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean_of_the_parts),
        cmocka_unit_test(test_nothing_to_choose),
        cmocka_unit_test(test_patterns),
        cmocka_unit_test(test_shares),
        cmocka_unit_test(test_white_furnace),
        cmocka_unit_test(test_light_and_medium_of_the_whole),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
