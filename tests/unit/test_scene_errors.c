/* What is said about bad scenes, and where. */
#include "scene_tests.h"

#define ONE "camera: {}\nobjects:\n"
#define SPHERE(inside) ONE "- sphere: {" inside "}\n"
#define MATERIAL(inside) "materials: {m: {" inside "}}\n" ONE "- sphere: {}\n"

typedef struct row {
    const char *text, *expected;
} row;

static void check(const row *rows, size_t count)
{
    size_t wrong = 0;
    for (size_t i = 0; i < count; i++)
        wrong += !reports(rows[i].text, rows[i].expected);
    assert_int_equal(wrong, 0);
}
#define CHECK(rows) check(rows, sizeof(rows) / sizeof(rows)[0])

static void test_keys(void **state)
{
    (void)state;
    static const row rows[] = {
        {SPHERE("centre: [0, 0, 0]"),
         "s.yaml:3:12: unknown key \"centre\" in sphere; did you mean \"center\"?\n"},
        {SPHERE("Radius: 1"), "3:12: unknown key \"Radius\" in sphere; did you mean \"radius\"?"},
        {SPHERE("bananas: 1"),
         "3:12: unknown key \"bananas\" in sphere, expected one of center, radius, material, "
         "shadow, scale, rotate, translate, matrix"},
        {"colour: 1\n" SPHERE(""), "1:1: unknown key \"colour\" in the scene, expected one of"},
        {"bakground: 1\n" SPHERE(""), "1:1: unknown key \"bakground\" in the scene; did you mean "
                                      "\"background\"?"},
        {SPHERE("radius: 1, radius: 2"), "3:23: duplicate key \"radius\", first given on line 3"},
        {"objects: []\n" ONE "- sphere: {}\n",
         "3:1: duplicate key \"objects\", first given on line 1"},
        {ONE "- sphre: {}\n", "3:3: unknown object \"sphre\"; did you mean \"sphere\"?"},
        {ONE "- torus: {}\n", "3:3: unknown object \"torus\", expected one of sphere, plane, box, "
                              "disk, rectangle, cylinder, cone, triangle, mesh, group"},
        {"lights: [{pont: {}}]\n" ONE "- sphere: {}\n",
         "1:11: unknown light \"pont\"; did you mean \"point\"?"},
        {SPHERE("material: glas") "materials: {glass: {}}\n",
         "3:22: unknown material \"glas\", expected a name from materials; did you mean "
         "\"glass\"?"},
        {SPHERE("material: x"), "3:22: unknown material \"x\", expected a name from materials\n"},
        {MATERIAL("color: {cheker: [0, 1]}"), "1:25: color has no pattern, expected checker, "
                                              "stripes, gradient, rings or image; did you mean "
                                              "\"checker\"?"},
        {MATERIAL("color: {checker: [0, 1], direction: [1, 0, 0]}"),
         "1:42: unknown key \"direction\" in checker"},
        {SPHERE("\"a\\tb\": 1"), "3:12: unknown key \"a\\x09b\" in sphere"},
        {ONE "- ? [a]\n  : 1\n", "3:5: this key is a list, expected a name"},
        {ONE "- ? {a: b}\n  : 1\n", "3:5: this key is a mapping, expected a name"},
    };
    CHECK(rows);
}

static void test_missing(void **state)
{
    (void)state;
    static const row rows[] = {
        {"objects:\n- sphere: {}\n", "1:1: the scene has no camera, expected a key such as"},
        {"camera: {}\n", "1:1: the scene has no \"objects\", expected a list of objects"},
        {"camera: {}\ncameras: {a: {}}\nobjects:\n- sphere: {}\n",
         "2:10: the scene has both camera and cameras, expected one of them"},
        {"camera: {}\nobjects: []\n", "2:10: objects is an empty list, expected a list of objects"},
        {"cameras: {}\nobjects: [{sphere: {}}]\n", "1:10: cameras is a mapping, expected"},
        {ONE "- box: {min: [0, 0, 0]}\n", "3:3: box has no \"max\", expected three numbers"},
        {ONE "- group: {}\n", "3:3: group has no \"objects\", expected a list of objects"},
        {ONE "- group: {objects: []}\n", "3:20: objects is an empty list"},
        {"lights: [{point: {}}]\n" ONE "- sphere: {}\n",
         "1:11: point has no \"position\", expected three numbers [x, y, z]"},
        {"lights: [{spot: {position: [0, 1, 0]}}]\n" ONE "- sphere: {}\n",
         "1:11: the spot has no \"to\" and no \"direction\", expected one of them"},
        {"lights: [{spot: {position: [0, 1, 0], to: [0, 0, 0], direction: [0, 1, 0]}}]\n" SPHERE(
             ""),
         "1:65: the spot has both \"to\" and \"direction\""},
        {"lights: [{point: {position: [0, 1, 0], intensity: 0}}]\n" SPHERE(""),
         "1:51: the point light is black; leave it out, or write `lights: []` for none"},
        {"lights: [{directional: {direction: [0, -1, 0], color: black}}]\n" SPHERE(""),
         "1:55: the directional light is black"},
        {"fog: {color: red}\n" SPHERE(""), "1:6: fog has no \"density\", expected a number"},
        {SPHERE("rotate: {angle: 3}"), "3:20: rotate has no \"axis\", expected three numbers"},
        {"camera: {aperture: 1, projection: panorama}\nobjects: [{sphere: {}}]\n",
         "1:20: the camera's aperture: only perspective cameras have an aperture, expected 0"},
        {"camera: {aperture: 2, focus: 0.001}\nobjects: [{sphere: {}}]\n",
         "1:20: the camera's aperture: expected at most 1000 times the distance"},
        {"camera: {blades: 2}\nobjects: [{sphere: {}}]\n",
         "1:18: the camera's blades: a polygon has 3 corners or more"},
        {"camera: {height: 1e-30}\nobjects: [{sphere: {}}]\n",
         "1:18: the camera's height: expected 0 or at least 1e-20"},
    };
    CHECK(rows);
}

static void test_values(void **state)
{
    (void)state;
    static const row rows[] = {
        {SPHERE("radius: -1"), "3:20: radius is -1, expected a number from 1e-20 to 1e12"},
        {SPHERE("radius: 0"), "3:20: radius is 0, expected a number from 1e-20 to 1e12"},
        {SPHERE("radius: .inf"), "3:20: radius is .inf, which is not finite"},
        {SPHERE("radius: -.INF"), "3:20: radius is -.INF, which is not finite"},
        {SPHERE("radius: .nan"), "3:20: radius is .nan, which is not finite"},
        {SPHERE("radius: 1e999"), "3:20: radius is 1e999, which is not finite"},
        {SPHERE("radius: 1_000"), "radius is 1_000, expected a number from 1e-20 to 1e12; "
                                  "numbers have no underscores in YAML 1.2"},
        {ONE "- sphere:\n    radius: 1,5\n", "decimals begin with a point, not a comma"},
        {SPHERE("radius: \"1.5\""), "3:20: radius is the text \"1.5\", expected a number from "
                                    "1e-20 to 1e12; remove the quotes"},
        {SPHERE("radius: [1]"), "3:20: radius is a list of 1, expected a number"},
        {SPHERE("radius: {}"), "3:20: radius is a mapping, expected a number"},
        {SPHERE("radius: big"), "3:20: radius is big, expected a number"},
        {SPHERE("radius: 1 m"), "3:20: radius is 1 m, expected a number"},
        {SPHERE("radius: 0x"), "3:20: radius is 0x, expected a number"},
        {SPHERE("radius: 1e"), "3:20: radius is 1e, expected a number"},
        {SPHERE("radius: ."), "3:20: radius is ., expected a number"},
        {SPHERE("radius: nan"), "3:20: radius is nan, expected a number"},
        {SPHERE("radius: ~"), "3:20: radius is empty, expected a number"},
        {SPHERE("shadow: yes"), "3:20: shadow is yes, which is only text in YAML 1.2, expected "
                                "true or false"},
        {SPHERE("shadow: 1"), "3:20: shadow is 1, expected true or false"},
        {SPHERE("center: [0, 0]"), "3:20: center is a list of 2, expected three numbers [x, y, z]"},
        {SPHERE("center: 1"), "3:20: center is 1, expected three numbers [x, y, z]"},
        {SPHERE("center: [0, x, 0]"), "3:24: y of center is x, expected a number"},
        {SPHERE("center: [0, 0, 2e12]"), "3:27: z of center is 2e12, expected a number from -1e12 "
                                         "to 1e12"},
        {"lavaray: 2\n" SPHERE(""), "1:10: lavaray is 2, expected 1"},
        {"image: {width: 0}\n" SPHERE(""), "1:16: width is 0, expected a whole number from 1 to "
                                           "32768"},
        {"image: {width: 1.5}\n" SPHERE(""), "1:16: width is 1.5, expected a whole number"},
        {"image: {depth: 65}\n" SPHERE(""), "1:16: depth is 65, expected a whole number from 0"},
        {"image: {seed: 4294967296}\n" SPHERE(""), "1:15: seed is 4294967296, expected a whole"},
        {MATERIAL("reflect: 1.5"), "1:26: reflect is 1.5, expected a number from 0 to 1"},
        {MATERIAL("transmit: [0, 2, 0]"), "1:31: g of transmit is 2, expected a number from 0"},
        {MATERIAL("diffuse: -1"), "1:26: diffuse is -1, expected a number from 0 to 1e12"},
        {MATERIAL("color: rde"), "color is rde, expected a colour: [r, g, b], one number, "
                                 "\"#rrggbb\" or a name, from 0 to 1e12; did you mean \"red\"?"},
        {MATERIAL("color: '#12'"), "1:24: color is the text \"#12\", expected # and 3 or 6 "
                                   "hexadecimal digits"},
        {MATERIAL("color: '0.5'"), "color is the text \"0.5\", expected a number from 0 to 1e12; "
                                   "remove the quotes"},
        {MATERIAL("color: {checker: [0]}"), "1:34: checker is a list of 1, expected two colours"},
        {MATERIAL("color: {checker: [0, rad]}"),
         "1:38: the second colour of checker is rad, expected a colour"},
        {MATERIAL("highlight: phog"), "1:28: highlight is phog, expected blinn or phong; did you "
                                      "mean \"phong\"?"},
        {MATERIAL("priority: 101"), "expected a whole number from -100 to 100"},
        {SPHERE("scale: 0"), "3:19: scale has a factor of 0"},
        {SPHERE("scale: [1, 0, 1]"), "3:19: scale has a factor of 0"},
        {SPHERE("scale: red"), "3:19: scale is red, expected a number"},
        {SPHERE("matrix: [[1, 0, 0, 0], [0, 1, 0, 0]]"),
         "3:20: matrix is a list of 2, expected three rows of four numbers"},
        {SPHERE("matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1]]"),
         "3:20: matrix is a list of 3, expected three rows of four numbers"},
        {SPHERE("matrix: [[1, 0, 0, 0], [0, 1, 0, x], [0, 0, 1, 0]]"),
         "number 4 of row 2 of matrix is x, expected a number from -1e12 to 1e12"},
        {SPHERE("matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 1, 0, 0]]"),
         "the transforms of this sphere are too extreme together"},
        {SPHERE("translate: [0, 0, 1], matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]"),
         "the sphere has a matrix and also scale, rotate or translate, expected only one way"},
        {SPHERE("rotate: 90"), "3:20: rotate is 90, expected three angles [x, y, z] or {axis: "
                               "[x, y, z], angle: degrees}"},
        {"camera: {fov: 180}\nobjects: [{sphere: {}}]\n",
         "1:15: fov is 180, expected a number above 0 and below 180"},
        {"lights: [{spot: {position: [0, 1, 0], to: [0, 0, 0], angle: 0}}]\n" SPHERE(""),
         "1:61: angle is 0, expected a number above 0 and at most 90"},
        {"lights: [{spot: {position: [0, 1, 0], to: [0, 0, 0], inner: 40}}]\n" SPHERE(""),
         "1:61: inner is 40, expected at most the angle, 30"},
        {"lights: 5\n" SPHERE(""), "1:9: lights is 5, expected a list of lights"},
        {"materials: 5\n" SPHERE(""), "1:12: materials is 5, expected a mapping of names"},
        {"background: {gradient: [0, 1, 2]}\n" SPHERE(""),
         "1:24: gradient is a list of 3, expected two colours"},
    };
    CHECK(rows);
}

static void test_shapes(void **state)
{
    (void)state;
    static const row rows[] = {
        {ONE "- plane: {normal: [0, 0, 0]}\n", "3:19: normal is [0, 0, 0], expected a direction"},
        {ONE "- box: {min: [0, 0, 0], max: [1, 0, 1]}\n",
         "3:30: y of max is 0, expected more than y of min, 0"},
        {ONE "- rectangle: {corner: [0, 0, 0], u: [1, 0, 0], v: [2, 0, 0]}\n",
         "3:51: v is parallel to u, expected two different directions"},
        {ONE "- rectangle: {corner: [0, 0, 0], u: [0, 0, 0], v: [2, 0, 0]}\n",
         "3:37: this edge of the rectangle has no length"},
        {ONE "- cylinder: {from: [1, 2, 3], to: [1, 2, 3]}\n",
         "3:35: from and to are the same point, expected two"},
        {ONE "- cone: {from: [0, 0, 0], to: [0, 1, 0], radius: 0}\n",
         "3:50: radius and top_radius are both 0"},
        {ONE "- triangle: {a: [0, 0, 0], b: [1, 1, 1], c: [2, 2, 2]}\n",
         "3:45: the corners lie on one line"},
        {ONE "- triangle: {a: [0, 0, 0], b: [0, 0, 0], c: [2, 2, 2]}\n",
         "3:45: the corners lie on one line"},
        {"camera: {from: [1, 1, 1], to: [1, 1, 1]}\nobjects: [{sphere: {}}]\n",
         "1:31: the camera's from and to are the same point, expected two"},
        {"camera: {from: [0, 9, 0]}\nobjects: [{sphere: {}}]\n",
         "1:16: the camera's up [0, 1, 0] lies along its view, expected another direction"},
        {"camera: {up: [0, 1, 5]}\nobjects: [{sphere: {}}]\n", "1:14: the camera's up [0, 1, 5]"},
        {"lights: [{spot: {position: [0, 1, 0], to: [0, 1, 0]}}]\n" SPHERE(""),
         "1:43: the spot's \"to\" is its position, expected another point"},
        {MATERIAL("color: {gradient: [0, 1], from: [0, 1, 0]}"),
         "1:49: the gradient's from and to are the same point"},
        {SPHERE("center: [1e12, 0, 0]"), "3:3: this object reaches beyond 1e12 metres"},
        {SPHERE("radius: 1e-12, scale: 1e-12"), "3:3: this object is smaller than 1e-20 metres"},
        {ONE "- group: {scale: 1e9, objects: [{group: {scale: 1e9, objects: [{sphere: {}}]}}]}\n",
         "the transforms of this group are too extreme together"},
    };
    CHECK(rows);
}

static void test_traps(void **state)
{
    (void)state;
    static const row rows[] = {
        {"materials:\n  m:\n    color: #ff0000\n" SPHERE(""),
         "3:12: color is empty, because an unquoted # starts a comment; quote the colour: "
         "\"#ff0000\"\n    3 |     color: #ff0000\n      |            ^\n"},
        {"background: #fff\n" SPHERE(""), "1:13: background is empty, because an unquoted #"},
        {"background:\n  gradient:\n  - #fff\n  - #000\n" SPHERE(""),
         "4:5: an unquoted # starts a comment, so the rest of this line is lost"},
        {"background:\n  gradient:\n    - #fff\n    - #000\n" SPHERE(""),
         "3:7: the first colour of gradient is empty, because an unquoted #"},
        {MATERIAL("color: #ff0000"), "1:24: an unquoted # starts a comment, so the rest of this "
                                     "line is lost; quote the colour: \"#ff0000\""},
        {SPHERE("radius:1"), "3:12: no space after the colon in \"radius:1\", expected "
                             "\"radius: 1\""},
        {ONE "- sphere:\n    radius:1\n    center: [0, 0, 0]\n",
         "4:11: no space after the colon, expected \"radius: 1\""},
        {ONE "- sphere:\n    center: [0, 0, 0]\n    radius:1\n",
         "5:11: no space after the colon, expected \"radius: 1\""},
        {ONE "- sphere:\n    radius:1\n",
         "4:5: sphere is the text \"radius:1\", expected a mapping such as {center: ...}; put a "
         "space after the colon"},
        {ONE "- sphere:\n  center: [0, 0, 0]\n",
         "4:3: center stands beside sphere, which is empty; indent the keys of sphere below it"},
        {ONE "- sphere:\n", "3:3: sphere is empty, expected its keys, indented below it, or {}"},
        {ONE "- sphere\n", "3:3: this object is sphere, expected a colon and its keys"},
        {ONE "-\n", "3:1: this item is empty, expected a value after the dash"},
        {ONE "-\n- sphere: {}\n", "3:1: this item is empty, expected a value after the dash"},
        {"camera: {}\nobjects:\n  -\n  - sphere: {}\n", "3:3: this object is empty, expected"},
        {ONE "- sphere: {}\n  material: glass\n",
         "4:3: material stands beside sphere, expected inside it, with the keys of sphere"},
        {ONE "- sphere: {}\n  plane: {}\n",
         "4:3: a second object in one item, expected a new item: \"- plane:\""},
        {"camera:\nfrom: [0, 0, 1]\nobjects: [{sphere: {}}]\n",
         "2:1: from belongs to camera, expected it indented deeper than camera"},
        {"materials:\n  a:\n  color: red\n" SPHERE(""),
         "3:3: color belongs to material \"a\", expected it indented deeper than that name"},
        {"materials:\n  color: red\n" SPHERE(""), "2:3: color stands directly in materials"},
        {"camera: {}\nobjects:\n  sphere: {}\n",
         "3:3: objects is a mapping, expected a list: begin each object with a dash"},
        {ONE "- sphere:\n\tradius: 1\n", "4:1: a tab indents this line, expected spaces"},
        {"? camera:\t- b\n", "1:10: a tab after this colon, expected spaces"},
        {"a: 1\n?\n  b : \t>\n", "3:6: a tab after this colon, expected spaces"},
        {ONE "- sphere: {radius: 1\n- plane: {}\n", "3:11: this { is not closed, expected a }"},
        {ONE "- sphere: {center: [1, 2}\n", "3:20: this [ is not closed, expected a ]"},
        {"camera: {}: {}\nobjects: []\n", "1:1"},
        {ONE "  - sphere: {}\n   - plane: {}\n", "4:4: this does not line up with the lines above"},
        {SPHERE("material: {color: \"red}"), "this text has no closing quote"},
        {"a: b: c\n", "1:5: a second \": \" on this line"},
        {SPHERE("<<: {radius: 1}"), "3:12: merge keys (<<) are not part of YAML 1.2"},
        {ONE "- sphere: !ball {}\n", "3:11: tags (!name) are not part of the scene language"},
        {SPHERE("radius: !!float 1"), "tags (!name) are not part of the scene language"},
        {SPHERE("") "---\na: 1\n", "4:1: a second document starts here"},
        {SPHERE("material: *m"), "3:22: alias *m has no anchor &m above it"},
        {"camera: {}\nobjects: &o\n- group: {objects: *o}\n",
         "3:20: alias *o stands inside the value it repeats"},
    };
    CHECK(rows);
}

static void test_whole_report(void **state)
{
    (void)state;
    const char *text = "camera: {}\n"
                       "objects:\n"
                       "- sphere: {radius: -1, centre: [0, 0, 0]}\n"
                       "- plane: {normal: [0, 0, 0]}\n";
    char *report = parse_bad(text, strlen(text));
    assert_string_equal(report,
                        "s.yaml:3:20: radius is -1, expected a number from 1e-20 to 1e12\n"
                        "    3 | - sphere: {radius: -1, centre: [0, 0, 0]}\n"
                        "      |                    ^\n"
                        "s.yaml:3:24: unknown key \"centre\" in sphere; did you mean "
                        "\"center\"?\n"
                        "    3 | - sphere: {radius: -1, centre: [0, 0, 0]}\n"
                        "      |                        ^\n"
                        "s.yaml:4:19: normal is [0, 0, 0], expected a direction, not all 0\n"
                        "    4 | - plane: {normal: [0, 0, 0]}\n"
                        "      |                   ^\n");
    free(report);
}

/* The caret stands below its character whatever is before it, and long lines are cut. */
static void test_excerpts(void **state)
{
    (void)state;
    assert_true(
        reports("{camera: {},\n\t\"objects\": [\t{\"x\": 1}]}\n",
                "s.yaml:2:16: unknown object \"x\", expected one of sphere, plane, box, disk, "
                "rectangle, cylinder, cone, triangle, mesh, group\n"
                "    2 |     \"objects\": [    {\"x\": 1}]}\n"
                "      |                      ^\n"));
    assert_true(reports(SPHERE("\"\xC3\xA9\xC3\xA9\": 1, radius: -1"),
                        "s.yaml:3:29: radius is -1, expected a number from 1e-20 to 1e12\n"
                        "    3 | - sphere: {\"\xC3\xA9\xC3\xA9\": 1, radius: -1}\n"
                        "      |                             ^\n"));
    assert_true(reports("\xEF\xBB\xBFx: 1\n", "s.yaml:1:1: unknown key \"x\""));
    assert_true(reports("camera: {}\r\nx: 1\r\n", "s.yaml:2:1: unknown key \"x\""));
    char text[2000];
    int used = snprintf(text, sizeof text, ONE "- sphere: {center: [0, 0, 0");
    memset(text + used, ' ', 500);
    snprintf(text + used + 500, sizeof text - 500 - (size_t)used, "], radius: -1}%*s}\n", 500, "");
    char *report = parse_bad(text, strlen(text));
    for (char *line = strtok(report, "\n"); line; line = strtok(NULL, "\n"))
        assert_true(strlen(line) <= 115);
    free(report);
}

static void test_many(void **state)
{
    (void)state;
    char text[8000] = ONE;
    for (int i = 0; i < 150; i++)
        strcat(text, "- sphere: {radius: -1}\n");
    assert_true(reports(text, "s.yaml:102:20: radius is -1"));
    assert_true(reports(text, "\n... and 50 more errors\n"));
    /* One wrong value behind several aliases is one error. */
    const char *aliases = "camera: {}\nmaterials:\n  a: &a {ior: 0}\n  b: *a\n  c: *a\n"
                          "objects: [{sphere: {}}]\n";
    char *report = parse_bad(aliases, strlen(aliases));
    assert_null(strstr(strstr(report, "ior is 0") + 1, "ior is 0"));
    free(report);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys),     cmocka_unit_test(test_missing),
        cmocka_unit_test(test_values),   cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_traps),    cmocka_unit_test(test_whole_report),
        cmocka_unit_test(test_excerpts), cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
