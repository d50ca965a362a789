/* Materials by model: which keys they have, what is said about others, and what the classic shading
 * shows of them. */
#include "scene_tests.h"

#define MATERIAL(inside) "materials: {m: {" inside "}}\ncamera: {}\nobjects:\n- sphere: {}\n"

/* The material, in a scene that the caller destroys. */
static const lr_material *read(const char *text, lr_scene **scene)
{
    *scene = parse_good(text);
    return &(*scene)->materials[0];
}

static void test_wrong_keys(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {MATERIAL("model: glas"), "1:24: model is glas, expected classic, diffuse"},
        {MATERIAL("model: conductor, reflect: 1"),
         "1:44: reflect is no key of materials of model conductor, expected model: classic\n"},
        {MATERIAL("roughness: 0.5"),
         "1:28: roughness is no key of materials of model classic, expected model: diffuse, "
         "dielectric, conductor, pbr, thin_glass\n"},
        {MATERIAL("model: pbr, metal: gold"),
         "1:36: metal is no key of materials of model pbr, expected model: conductor\n"},
        {MATERIAL("model: dielectric, color: red"), "color is no key of materials of model diel"},
        {MATERIAL("model: conductor, metal: gold, eta: 1, k: 1"),
         "1:42: metal stands beside eta, expected one of the two"},
        {MATERIAL("model: conductor, eta: 1"), "1:40: eta needs k beside it"},
        {MATERIAL("model: conductor, k: 1"), "1:38: k needs eta beside it"},
        {MATERIAL("model: conductor, metal: unobtainium"), "expected none, gold"},
        {MATERIAL("model: pbr, roughness: -0.1"),
         "1:40: roughness is -0.1, expected a number from 0 to 1"},
        {MATERIAL("model: pbr, roughness: .nan"), "roughness is .nan"},
        {MATERIAL("model: pbr, metallic: 1.5"), "metallic is 1.5, expected a number from 0 to 1"},
        {MATERIAL("model: dielectric, ior: 0"), "ior is 0, expected a number from 0.01 to 100"},
        {MATERIAL("model: pbr, sheen: 2"), "sheen is 2"},
    };
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        wrong += !reports(rows[i][0], rows[i][1]);
    assert_int_equal(wrong, 0);
}

static void test_values(void **state)
{
    (void)state;
    lr_scene *scene;
    const lr_material *m = read(MATERIAL("model: pbr, color: [1, 0.5, 0], roughness: 0.25, "
                                         "metallic: 0.5, transmission: 0.75, ior: 1.2, "
                                         "clearcoat: 0.125, clearcoat_roughness: 0.375, "
                                         "sheen: [0.1, 0.2, 0.3], sheen_roughness: 0.625"),
                                &scene);
    assert_int_equal(m->model, LR_MODEL_PBR);
    assert_near(m->roughness, 0.25, 0);
    assert_near(m->metallic, 0.5, 0);
    assert_near(m->transmission, 0.75, 0);
    assert_near(m->clearcoat, 0.125, 0);
    assert_near(m->clearcoat_roughness, 0.375, 0);
    assert_near(m->sheen.z, 0.3, 0);
    assert_near(m->sheen_roughness, 0.625, 0);
    /* (1 - metallic) transmission times the colour */
    assert_near(m->transmit.x, 0.375, 1e-15);
    assert_near(m->transmit.y, 0.1875, 1e-15);
    assert_true(m->fresnel);
    lr_scene_destroy(scene);

    m = read(MATERIAL("model: dielectric"), &scene);
    assert_near(m->transmit.x, 1, 0);
    assert_near(m->diffuse.x, 0, 0);
    assert_near(m->ior, 1.5, 0);
    assert_true(m->fresnel);
    lr_scene_destroy(scene);

    m = read(MATERIAL("model: thin_glass, transmit: [0.5, 0, 1]"), &scene);
    assert_near(m->transmit.x, 0.5, 0);
    lr_scene_destroy(scene);

    /* F = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) */
    m = read(MATERIAL("model: conductor, eta: 2, k: 3"), &scene);
    assert_near(m->reflect.x, 10.0 / 18, 1e-15);
    assert_near(m->color.colors[0].x, 1, 0);
    assert_near(m->diffuse.x, 0, 0);
    lr_scene_destroy(scene);

    m = read(MATERIAL("model: conductor, metal: gold"), &scene);
    assert_true(m->reflect.x > 0.9 && m->reflect.x > m->reflect.y && m->reflect.y > m->reflect.z);
    assert_near(m->eta.x, 0.14304, 1e-9);
    lr_scene_destroy(scene);

    m = read(MATERIAL("model: conductor, color: [0.5, 0.25, 0], roughness: 1"), &scene);
    assert_near(m->reflect.x, 0, 0);
    assert_near(m->diffuse.x, 1, 0);
    lr_scene_destroy(scene);
}

/* What a scene says of materials and a ball with the first of them. */
#define MATERIALS(inside) "materials: {" inside "}\ncamera: {}\nobjects:\n- sphere: {}\n"
#define GLASS(more) "{model: dielectric, " more "}"

static void test_wrong_mixes(void **state)
{
    (void)state;
    static const char *const rows[][2] = {
        {MATERIAL("model: mix"), "1:13: model mix needs first, the name of a material or a"},
        {MATERIAL("model: mix, first: {}"), "1:13: model mix needs second, the name of"},
        {MATERIAL("model: mix, first: x, second: {}"), "1:36: unknown material \"x\", expected"},
        {MATERIAL("model: mix, first: 7, second: []"),
         "1:47: material is an empty list, expected the name of a material or a mapping"},
        {MATERIAL("first: {}"),
         "first is no key of materials of model classic, expected model: mix"},
        {MATERIAL("model: mix, first: {}, second: {}, color: 1"), "color is no key of materials"},
        {MATERIAL("model: mix, first: {}, second: {}, alpha_cutoff: 0.5"),
         "alpha_cutoff is no key of materials of model mix, expected model: classic, diffuse, "
         "dielectric, conductor, pbr, thin_glass\n"},
        {MATERIAL("model: mix, first: {}, second: {}, weight: 1.5"),
         "1:60: weight is 1.5, expected a number from 0 to 1"},
        {MATERIAL("model: mix, first: {}, second: {}, weight: {cheker: [0, 1]}"),
         "1:61: weight has no pattern, expected checker, stripes, gradient, rings or image; did"},
        {MATERIAL("model: mix, first: {emission: 1}, second: {}"),
         "1:36: the first material of the mix has emission, expected it as a key of the mix"},
        {MATERIAL("model: mix, first: {}, second: {one_sided: true}"),
         "1:48: the second material of the mix has one_sided, expected"},
        {MATERIAL("model: mix, first: {}, second: {emits: front}"),
         "second material of the mix has emits"},
        {MATERIAL("model: mix, first: {alpha_cutoff: 0.5}, second: {}"),
         "1:36: the first material of the mix has alpha_cutoff, expected none: where there is to "
         "be "
         "no surface, a weight can choose {model: thin_glass, ior: 1}"},
        {MATERIAL("model: mix, first: " GLASS("") ", second: " GLASS("ior: 1.3")),
         "both materials of the mix let light in, expected the same ior, absorption, scattering, "},
        {MATERIAL("model: mix, first: " GLASS("") ", second: " GLASS("absorption: 1")),
         "expected the same ior, absorption, scattering, "},
        {MATERIAL("model: mix, first: " GLASS("") ", second: " GLASS("priority: 1")),
         "expected the same ior, absorption, scattering, "},
        {MATERIAL("model: mix, first: " GLASS("") ", second: {model: thin_glass}"),
         "one material of the mix fills the inside, the other is thin_glass"},
        {MATERIAL("model: mix, first: m, second: {}"),
         "1:13: the mix is nested more than 4 deep, or a part of itself\n"},
        {MATERIALS("a: {model: mix, first: b, second: {}}, b: {model: mix, first: {}, second: a}"),
         "1:13: the mix is nested more than 4 deep, or a part of itself\n"},
        {MATERIALS("a: {model: mix, first: b, second: {}}, b: {model: mix, first: c, second: {}}, "
                   "c: {model: mix, first: d, second: {}}, d: {model: mix, first: e, second: {}}, "
                   "e: {model: mix, first: {}, second: {}}"),
         "1:13: the mix is nested more than 4 deep"},
        /* What is wrong is no part of others that are read later. */
        {"materials: {m: {model: mix, first: m, second: {}}}\ncamera: {}\nobjects:\n- sphere: "
         "{material: {model: mix, first: m, second: m, weight: 2}}\n",
         "weight is 2"},
        {"materials: {m: {model: mix, first: {}}}\ncamera: {}\nobjects:\n- sphere: "
         "{material: {model: mix, first: m, second: m, weight: {image: none.png}}}\n",
         "none.png"},
    };
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        wrong += !reports(rows[i][0], rows[i][1]);
    assert_int_equal(wrong, 0);
}

static void test_mixes(void **state)
{
    (void)state;
    lr_scene *scene;
    /* Names may come in any order, and parts within parts. */
    const lr_material *m =
        read(MATERIALS("m: {model: mix, first: n, second: glass, weight: 0.25}, n: {model: mix, "
                       "first: {color: [1, 0.5, 0]}, second: red, weight: {stripes: [0, 1], size: "
                       "2}}, glass: {model: dielectric, transmit: 0.8, ior: 1.2, priority: 3}, "
                       "red: {color: [0, 0, 1], diffuse: 0.5, reflect: 0.4}"),
             &scene);
    const lr_material *n = &scene->materials[1];
    assert_int_equal(scene->material_count, 6);
    assert_int_equal(m->mix.first, 1);
    assert_int_equal(m->mix.second, 2);
    assert_int_equal(m->mix.nesting, 2);
    assert_int_equal(n->mix.first, 4);
    assert_int_equal(n->mix.second, 3);
    assert_int_equal(n->mix.nesting, 1);
    assert_int_equal(n->mix.weight.kind, LR_PATTERN_STRIPES);
    /* The pattern in the parts' matt colours; all else averaged. */
    assert_int_equal(n->color.kind, LR_PATTERN_STRIPES);
    assert_near(n->color.size, 2, 0);
    assert_near(n->color.colors[0].y, 0.5, 0);
    assert_near(n->color.colors[1].z, 0.5, 0);
    assert_near(n->color.colors[1].x, 0, 0);
    assert_near(n->reflect.x, 0.2, 1e-15);
    assert_near(n->diffuse.x, 1, 0);
    assert_near(m->color.colors[0].x, 0.75 * 0.5, 1e-15);
    assert_near(m->reflect.x, 0.15, 1e-15);
    assert_near(m->transmit.x, 0.2, 1e-15);
    assert_near(m->ior, 1.2, 0);
    assert_int_equal(m->priority, 3);
    assert_false(m->pane);
    lr_scene_destroy(scene);

    m = read(MATERIAL("model: mix, first: {}, second: {model: thin_glass}, emission: 2"), &scene);
    assert_true(m->pane);
    assert_near(m->emission.x, 2, 0);
    assert_near(m->mix.weight.colors[0].x, 0.5, 0);
    assert_near(m->transmit.x, 0.5, 0);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrong_keys),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_wrong_mixes),
        cmocka_unit_test(test_mixes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
