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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrong_keys),
        cmocka_unit_test(test_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
