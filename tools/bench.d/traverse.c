/* Times the kernels that find hits in trees, alone, beside Embree on the same rays, and what a mesh
 * takes until then: JSON for `tools/bench --traverse` and --growth.
 *
 * bench_traverse write SIDE FILE.ply         writes hills of 2 SIDE^2 triangles
 * bench_traverse measure SIDE FILE.ply RUNS  measures them */
#include "traverse.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gpu/commands.h"
#include "render/wavefront.h"

enum { CHUNK = 65536, HOW_MANY_WAYS = 2 }; /* packets, single rays */

static const char *const kind_names[] = {"primary", "shadow", "bounce"};

static void check(lr_status status, const lr_error *error)
{
    if (status == LR_OK)
        return;
    fprintf(stderr, "bench_traverse: %s\n", error->message);
    exit(1);
}

static void write_ply(const mesh *m, const char *path)
{
    FILE *out = fopen(path, "wb");
    if (!out) {
        perror(path);
        exit(1);
    }
    fprintf(out,
            "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\n"
            "property float y\nproperty float z\nelement face %u\n"
            "property list uchar uint vertex_indices\nend_header\n",
            m->vertex_count, m->count);
    fwrite(m->vertices, sizeof *m->vertices, m->vertex_count, out);
    for (uint32_t i = 0; i < m->count; i++) {
        fputc(3, out);
        fwrite(m->triangles[i], sizeof *m->triangles, 1, out);
    }
    if (ferror(out) | fclose(out)) {
        perror(path);
        exit(1);
    }
}

/* ---- The device ---------------------------------------------------------------------------- */

typedef struct prepared {
    lr_device *device;
    lr_scene *scene;
    lr_packed_scene packed;
    lr_wavefront waves[HOW_MANY_WAYS];
    json_t *costs; /* of the way there */
} prepared;

static double peak_bytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss;
}

/* Reads, packs and uploads the mesh, and takes the time. */
static void prepare(prepared *p, const char *path, const ray_set *set, uint32_t triangles)
{
    static timing load, build, upload;
    lr_error error;
    lr_render_stats stats = {0};
    char *report = NULL;
    lr_render_options options = {.chunk_rays = CHUNK, .tile_size = 256};
    check(lr_device_open(&(lr_device_desc){0}, &p->device, &error), &error);
    timing_start(&load);
    check(lr_scene_load(path, NULL, &p->scene, &report, &error), &error);
    timing_stop(&load);
    timing_next(&load);
    static lr_light light;
    light = (lr_light){.kind = LR_LIGHT_POINT,
                       .color = {1, 1, 1},
                       .intensity = 1,
                       .position = {set->light[0], set->light[1], set->light[2]},
                       .shadows = true};
    free(p->scene->lights);
    p->scene->lights = malloc(sizeof light);
    *p->scene->lights = light;
    p->scene->light_count = 1;
    p->scene->default_light = false;
    lr_settings settings = {
        .width = 256, .height = 256, .samples = 1, .camera = &p->scene->cameras[0]};
    timing_start(&build);
    check(lr_pack_scene(p->scene, &settings, &p->packed, &error), &error);
    timing_stop(&build);
    timing_next(&build);
    for (int i = 0; i < HOW_MANY_WAYS; i++) {
        options.single_rays = i == 1;
        check(lr_wavefront_create(p->device, &p->packed, &options, &stats, &p->waves[i], &error),
              &error);
        if (i == 0)
            upload = (timing){{stats.upload_cpu_seconds}, {stats.upload_seconds}, 1};
        if (i == 0)
            p->costs =
                json_pack("{s:o, s:o, s:o, s:f, s:f}", "load", summary(&load), "build",
                          summary(&build), "upload", summary(&upload), "device_bytes_per_triangle",
                          16.0 * p->packed.row_count / triangles, "peak_bytes", peak_bytes());
    }
}

static void upload_rays(lr_wavefront *w, const ray *rays, uint32_t count, int kind)
{
    static struct gpu_ray queue[CHUNK];
    static struct gpu_shadow_ray shadows[CHUNK];
    lr_error error;
    for (uint32_t i = 0; i < count; i++) {
        vec3 origin = {rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]};
        vec3 direction = {rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]};
        uint32_t pixel = i % (w->tile_size * w->tile_size);
        queue[i] = (struct gpu_ray){
            .origin = origin, .pixel = pixel, .direction = direction, .weight = {1, 1, 1}};
        shadows[i] = (struct gpu_shadow_ray){.origin = origin, .pixel = pixel, .value = {1, 1, 1}};
    }
    if (kind == SHADOW)
        check(
            lr_buffer_upload(w->device, &w->shadow_rays, shadows, sizeof *shadows * count, &error),
            &error);
    else
        check(lr_buffer_upload(w->device, w->queues[0].rays, queue, sizeof *queue * count, &error),
              &error);
}

static uint32_t count_found(lr_wavefront *w, uint32_t count)
{
    static lr_buffer host;
    lr_error error;
    uint32_t hits = 0;
    VkDeviceSize size = sizeof(struct gpu_hit) * (VkDeviceSize)count;
    check(lr_buffer_create(w->device, LR_BUFFER_HOST, size, "the hits", &host, &error), &error);
    check(lr_commands_begin(w->device, &error), &error);
    lr_commands_copy(w->device, &w->found, &host, size);
    check(lr_commands_finish(w->device, &error), &error);
    const struct gpu_hit *found = host.mapped;
    for (uint32_t i = 0; i < count; i++)
        hits += found[i].primitive != LR_PRIMITIVE_NONE;
    lr_buffer_destroy(w->device, &host);
    return hits;
}

/* Traces all rays, a chunk at a time; only the kernel is timed. Returns how many met something. */
static uint32_t device_trace(lr_wavefront *w, const ray_set *set, int kind, timing *t)
{
    lr_error error;
    uint32_t hits = 0;
    for (uint32_t first = 0; first < set->count[kind]; first += CHUNK) {
        uint32_t count = set->count[kind] - first < CHUNK ? set->count[kind] - first : CHUNK;
        upload_rays(w, set->rays[kind] + first, count, kind);
        struct gpu_work work = {.count = count, .shadow_room = w->shadow_room, .tile_width = 256};
        struct gpu_counters zero = {.hit_groups_y = 1, .hit_groups_z = 1};
        uint32_t a_group = LR_GROUP_SIZE * w->rays_at_once;
        check(lr_commands_begin(w->device, &error), &error);
        lr_commands_write(w->device, &w->counters, 0, &zero, sizeof zero);
        check(lr_commands_finish(w->device, &error), &error);
        timing_start(t);
        check(lr_commands_begin(w->device, &error), &error);
        lr_commands_dispatch(w->device, &w->layout, kind == SHADOW ? w->shadow : w->nearest, w->set,
                             &work, (count + a_group - 1) / a_group, 1, 1);
        check(lr_commands_finish(w->device, &error), &error);
        timing_stop(t);
        check(lr_commands_begin(w->device, &error), &error);
        lr_commands_copy(w->device, &w->counters, &w->counters_host, sizeof zero);
        check(lr_commands_finish(w->device, &error), &error);
        const struct gpu_counters *c = w->counters_host.mapped;
        hits += kind == SHADOW ? c->shadow_hits : count_found(w, count);
    }
    timing_next(t);
    return hits;
}

/* ---- The measurement ----------------------------------------------------------------------- */

static json_t *rates(timing *t, uint32_t rays, uint32_t hits)
{
    double cpu = median(t->cpu, t->count), wall = median(t->wall, t->count);
    return json_pack("{s:f, s:f, s:i}", "mrays_per_cpu_second", 1e-6 * rays / cpu,
                     "mrays_per_second", 1e-6 * rays / wall, "hits", (int)hits);
}

static json_t *measure_kind(prepared *p, embree *e, const ray_set *set, int kind, int runs)
{
    static timing ours[HOW_MANY_WAYS], theirs[HOW_MANY_WAYS];
    static const char *const names[2][HOW_MANY_WAYS] = {{"lavaray_packets", "lavaray_single"},
                                                        {"embree_packets", "embree_single"}};
    uint32_t our_hits[HOW_MANY_WAYS] = {0}, their_hits[HOW_MANY_WAYS] = {0};
    json_t *result = json_pack("{s:i}", "rays", (int)set->count[kind]);
    /* The first run warms up. */
    for (int run = 0; run <= runs; run++)
        for (int i = 0; i < HOW_MANY_WAYS; i++) {
            if (run < 2)
                ours[i] = theirs[i] = (timing){0};
            our_hits[i] = device_trace(&p->waves[i], set, kind, &ours[i]);
            if (!e)
                continue;
            timing_start(&theirs[i]);
            their_hits[i] = embree_trace(e, set, kind, i == 0);
            timing_stop(&theirs[i]);
            timing_next(&theirs[i]);
        }
    for (int i = 0; i < HOW_MANY_WAYS; i++) {
        json_object_set_new(result, names[0][i], rates(&ours[i], set->count[kind], our_hits[i]));
        if (!e)
            continue;
        json_object_set_new(result, names[1][i],
                            rates(&theirs[i], set->count[kind], their_hits[i]));
        if (fabs((double)our_hits[i] - their_hits[i]) > 1e-3 * set->count[kind]) {
            fprintf(stderr, "bench_traverse: %s, %s: %u hits, Embree %u\n", kind_names[kind],
                    names[0][i], our_hits[i], their_hits[i]);
            exit(1);
        }
    }
    return result;
}

static void measure(uint32_t side, const char *path, int runs)
{
    prepared p = {0};
    ray_set set = {.light = {-1, 2, 0.2f}};
    prepare(&p, path, &set, 2 * side * side);
    mesh m = mesh_terrain(side);
    set = make_rays(&m);
    embree *e = embree_open(&m);
    json_t *result = json_pack("{s:i, s:s, s:o}", "triangles", (int)m.count, "device",
                               lr_device_get_info(p.device)->name, "costs", p.costs);
    for (int kind = 0; kind < RAY_KINDS; kind++)
        json_object_set_new(result, kind_names[kind], measure_kind(&p, e, &set, kind, runs));
    json_dumpf(result, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(4));
    putchar('\n');
    json_decref(result);
    embree_close(e);
    free_rays(&set);
    mesh_free(&m);
    for (int i = 0; i < HOW_MANY_WAYS; i++)
        lr_wavefront_destroy(&p.waves[i]);
    lr_packed_scene_free(&p.packed);
    lr_scene_destroy(p.scene);
    lr_device_close(p.device);
}

int main(int count, char **arguments)
{
    long side = count > 2 ? strtol(arguments[2], NULL, 10) : 0;
    if (side > 0 && side < 20000 && count == 4 && !strcmp(arguments[1], "write")) {
        mesh m = mesh_terrain((uint32_t)side);
        write_ply(&m, arguments[3]);
        mesh_free(&m);
    } else if (side > 0 && side < 20000 && count == 5 && !strcmp(arguments[1], "measure")) {
        measure((uint32_t)side, arguments[3], runs_from(arguments[4]));
    } else {
        fputs("usage: bench_traverse write SIDE FILE.ply | measure SIDE FILE.ply RUNS\n", stderr);
        return 2;
    }
    return 0;
}
