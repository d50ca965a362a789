#include "cli/json.h"
#include "cli/load.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>

typedef struct values {
    load_values load;
    bool json;
} values;

static const option options[] = {
    LOAD_OPTIONS(values),
    {.name = "json", .kind = OPTION_FLAG, .offset = offsetof(values, json), .help = "print JSON"},
};

static const char *plural(uint64_t count)
{
    return count == 1 ? "" : "s";
}

/* ": 2 point, 1 spot" for the kinds that there are. */
static void print_kind(const char *name, uint32_t count, bool *first)
{
    if (count > 0) {
        printf("%s %u %s", *first ? ":" : ",", (unsigned)count, name);
        *first = false;
    }
}

static void print_cameras(const lr_scene *scene, const lr_scene_info *info)
{
    printf("  cameras    %u", (unsigned)info->cameras);
    bool named = lr_scene_camera_name(scene, 0) != NULL;
    for (uint32_t i = 0; named && i < info->cameras; i++) {
        printf("%s %s", i ? "," : ":", lr_scene_camera_name(scene, i));
    }
    putchar('\n');
}

static void print_lights(const lr_scene_info *info, const lr_scene_facts *facts)
{
    uint32_t written = facts->point_lights + facts->directional_lights + facts->spot_lights;
    bool first = true;
    printf("  lights     %u", (unsigned)info->lights);
    print_kind("point", facts->point_lights, &first);
    print_kind("directional", facts->directional_lights, &first);
    print_kind("spot", facts->spot_lights, &first);
    print_kind("added to suit the camera", info->lights - written, &first);
    putchar('\n');
}

static void print_objects(const lr_scene_info *info, const lr_scene_facts *facts)
{
    bool first = true;
    printf("  objects    %u", (unsigned)info->objects);
    for (int i = 0; i < LR_OBJECT_KINDS; i++) {
        print_kind(facts->objects[i].name, facts->objects[i].count, &first);
    }
    putchar('\n');
}

static void print_text(const char *path, const lr_scene *scene, const lr_scene_info *info,
                       const lr_scene_facts *facts)
{
    printf("%s\n", path);
    print_cameras(scene, info);
    print_lights(info, facts);
    printf("  materials  %u\n", (unsigned)info->materials);
    printf("  textures   %u", (unsigned)facts->textures);
    printf(facts->textures ? ": %" PRIu64 " texels\n" : "\n", facts->texels);
    print_objects(info, facts);
    printf("  meshes     %u", (unsigned)info->meshes);
    if (info->meshes > 0) {
        printf(": %" PRIu64 " triangle%s (%" PRIu64 " shown), %" PRIu64 " vertices",
               facts->triangles, plural(facts->triangles), facts->shown_triangles, facts->vertices);
    }
    putchar('\n');
    if (facts->bounded) {
        printf("  bounds     [%.6g, %.6g, %.6g] to [%.6g, %.6g, %.6g]\n", facts->min[0],
               facts->min[1], facts->min[2], facts->max[0], facts->max[1], facts->max[2]);
    }
    if (info->moves) {
        printf("  motion     from frame to frame%s\n",
               info->blurs ? ", and while the shutter is open, not of cameras alone" : "");
    }
    printf("  memory     %" PRIu64 " bytes\n", facts->bytes);
    printf("  file       SHA-256 %s\n", info->sha256);
    printf("  scene      SHA-256 %s\n", facts->sha256);
    for (uint32_t i = 0; i < info->note_count; i++) {
        printf("  note       %s\n", info->notes[i]);
    }
}

static json_t *objects_json(const lr_scene_facts *facts)
{
    json_t *objects = json_object();
    for (int i = 0; i < LR_OBJECT_KINDS; i++) {
        json_object_set_new(objects, facts->objects[i].name, json_integer(facts->objects[i].count));
    }
    return objects;
}

static json_t *cameras_json(const lr_scene *scene, uint32_t count)
{
    json_t *cameras = json_array();
    for (uint32_t i = 0; i < count; i++) {
        const char *name = lr_scene_camera_name(scene, i);
        json_array_append_new(cameras, name ? json_string(name) : json_null());
    }
    return cameras;
}

static json_t *notes_json(const lr_scene_info *info)
{
    json_t *notes = json_array();
    for (uint32_t i = 0; i < info->note_count; i++) {
        json_array_append_new(notes, json_string(info->notes[i]));
    }
    return notes;
}

static json_t *bounds_json(const lr_scene_facts *facts)
{
    const double *a = facts->min, *b = facts->max;
    return facts->bounded ? json_pack("[[f, f, f], [f, f, f]]", a[0], a[1], a[2], b[0], b[1], b[2])
                          : json_null();
}

static int print_json(const char *path, const lr_scene *scene, const lr_scene_info *info,
                      const lr_scene_facts *facts)
{
    uint32_t written = facts->point_lights + facts->directional_lights + facts->spot_lights;
    json_t *json = json_pack(
        "{s:s, s:s, s:s, s:o, s:{s:i, s:i, s:i, s:i}, s:i, s:{s:i, s:I}, s:o, s:{s:i, s:I, s:I, "
        "s:I},"
        " s:o, s:b, s:b, s:I, s:o}",
        "scene", path, "file_sha256", info->sha256, "scene_sha256", facts->sha256, "cameras",
        cameras_json(scene, info->cameras), "lights", "point", (int)facts->point_lights,
        "directional", (int)facts->directional_lights, "spot", (int)facts->spot_lights, "added",
        (int)(info->lights - written), "materials", (int)info->materials, "textures", "count",
        (int)facts->textures, "texels", (json_int_t)facts->texels, "objects", objects_json(facts),
        "meshes", "count", (int)info->meshes, "triangles", (json_int_t)facts->triangles,
        "shown_triangles", (json_int_t)facts->shown_triangles, "vertices",
        (json_int_t)facts->vertices, "bounds", bounds_json(facts), "moves", (int)info->moves,
        "blurs", (int)info->blurs, "memory_bytes", (json_int_t)facts->bytes, "notes",
        notes_json(info));
    return write_json(json, "-");
}

static int run(const command *self, int argc, char **argv)
{
    values v = {0};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    lr_scene *scene = NULL;
    int code = load_scene(argv[0], &v.load, true, &scene, NULL); /* notes stand in the list */
    if (code == EXIT_FINE) {
        lr_scene_info info;
        lr_scene_facts facts;
        lr_scene_get_info(scene, &info);
        lr_scene_get_facts(scene, &facts);
        if (v.json) {
            code = print_json(argv[0], scene, &info, &facts);
        } else {
            print_text(argv[0], scene, &info, &facts);
        }
    }
    lr_scene_destroy(scene);
    return code;
}

const command command_info = {
    .name = "info",
    .operands = "SCENE",
    .summary = "print what a scene holds, and the hash of its numbers",
    .details = "Reads SCENE (\"-\" is standard input) and prints its cameras, lights, objects,\n"
               "meshes and textures in numbers, its bounds, the memory of its arrays, what of\n"
               "other programs' files is left out, and a hash of all numbers that shape the\n"
               "picture: two machines that print the same hash read the same scene. Needs no\n"
               "Vulkan.",
    .examples = "  lavaray info gears.nff\n"
                "  lavaray info --json model.glb",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
