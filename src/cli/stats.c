#include "cli/stats.h"

#include "base/file.h"
#include "cli/cli.h"
#include "cli/json.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <sys/resource.h>

#include <jansson.h>

static uint64_t rays_traced(const lr_render_stats *s)
{
    return s->primary.traced + s->reflected.traced + s->refracted.traced + s->bounced.traced +
           s->shadow.traced;
}

static double rays_per_second(const lr_render_stats *s)
{
    return s->trace_seconds > 0 ? (double)rays_traced(s) / s->trace_seconds : 0;
}

static uint64_t peak_memory(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

static const char *output_name(const render_record *r)
{
    return strcmp(r->output, "-") == 0 ? "standard output" : r->output;
}

/* Such as "4 samples"; "samples 0-15 of 64" or "sample 5 of 64" for a part. */
static void format_samples(const lr_render_stats *s, char text[64])
{
    if (s->least_samples < s->most_samples) {
        snprintf(text, 64, "%.1f samples (%u to %u)", s->mean_samples, (unsigned)s->least_samples,
                 (unsigned)s->most_samples);
    } else if (s->sample_count < s->samples && s->sample_count == 1) {
        snprintf(text, 64, "sample %u of %u", (unsigned)s->first_sample, (unsigned)s->samples);
    } else if (s->sample_count < s->samples) {
        snprintf(text, 64, "samples %u-%u of %u", (unsigned)s->first_sample,
                 (unsigned)(s->first_sample + s->sample_count - 1), (unsigned)s->samples);
    } else {
        snprintf(text, 64, "%u sample%s", (unsigned)s->samples, s->samples == 1 ? "" : "s");
    }
}

void print_record_line(const render_record *r)
{
    char samples[64];
    format_samples(&r->stats, samples);
    fprintf(stderr, "wrote %s, %u×%u, %s, %.1f Mray/s on %s, %.1f s\n", output_name(r),
            (unsigned)r->width, (unsigned)r->height, samples, 1e-6 * rays_per_second(&r->stats),
            r->device.name, r->total_seconds);
}

static void print_rays(const char *name, uint64_t traced, uint64_t hit)
{
    if (traced) {
        fprintf(stderr, "  %-11s %14" PRIu64 "  %5.1f %% hit\n", name, traced,
                100.0 * (double)hit / (double)traced);
    }
}

static void print_count(const char *name, uint64_t count)
{
    if (count) {
        fprintf(stderr, "  %-26s %12" PRIu64 "\n", name, count);
    }
}

static uint32_t layer_count(const render_record *r)
{
    return r->layers ? r->layers->count : 0;
}

static void print_layers(const render_record *r)
{
    uint32_t count = layer_count(r);
    for (uint32_t i = 0; i < count; i++) {
        fprintf(stderr, "%s%s", i ? ", " : "layers   ", r->layers->layers[i].name);
    }
    if (count) {
        fprintf(stderr, "; %.3f s more\n", r->stats.layers_seconds);
    }
}

void print_record(const render_record *r)
{
    const lr_render_stats *s = &r->stats;
    char samples[64];
    format_samples(s, samples);
    fprintf(stderr,
            "wrote %s, %u×%u of %u×%u, %s, depth %u, seed %u\n"
            "device   %s\n         %s, Vulkan %s, %s, %s\n"
            "hash     %s\n"
            "rays\n",
            output_name(r), (unsigned)r->width, (unsigned)r->height, (unsigned)s->width,
            (unsigned)s->height, samples, (unsigned)s->depth, (unsigned)s->seed, r->device.name,
            r->device.driver, format_version(r->device.api_version).text,
            r->device.software ? "software" : "GPU", r->exact ? "exact" : "not exact", s->hash);
    print_rays("primary", s->primary.traced, s->primary.hit);
    print_rays("reflected", s->reflected.traced, s->reflected.hit);
    print_rays("refracted", s->refracted.traced, s->refracted.hit);
    print_rays("bounced", s->bounced.traced, s->bounced.hit);
    print_rays("shadow", s->shadow.traced, s->shadow.hit);
    fprintf(stderr, "  %-11s %14" PRIu64 "  %.2f Mray/s\n", "all", rays_traced(s),
            1e-6 * rays_per_second(s));
    if (s->resumed > 0) {
        fprintf(stderr, "  %.1f %% of the samples are from the checkpoint, without their rays\n",
                100 * s->resumed);
    }
    print_count("hidden surfaces passed", s->passed);
    print_count("not traced: depth", s->dropped_depth);
    print_count("not traced: weight", s->dropped_weight);
    print_count("media lost: nesting", s->dropped_nesting);
    print_layers(r);
    if (r->denoiser) {
        fprintf(stderr, "denoised by %s in %.3f s\n", r->denoiser, r->denoise_seconds);
    }
    fprintf(stderr,
            "seconds  %.3f: device %.3f, scene %.3f, build %.3f, upload %.3f,\n"
            "         compile %.3f, trace %.3f, read back %.3f, write %.3f; longest pass %.3f\n"
            "memory   %.1f MiB at most\n",
            r->total_seconds, r->device_seconds, r->parse_seconds, s->build_seconds,
            s->upload_seconds, s->compile_seconds, s->trace_seconds, s->read_back_seconds,
            r->write_seconds, s->longest_pass_seconds, (double)peak_memory() / (1 << 20));
}

void print_record_warnings(const render_record *r)
{
    const lr_render_stats *s = &r->stats;
    if (!r->exact) {
        print_warning("%s fails the arithmetic self-test: this picture may differ from that of "
                      "other devices",
                      r->device.name);
    }
    if (s->non_finite) {
        print_warning("%" PRIu64 " contributions were infinite or not a number and were left out",
                      s->non_finite);
    }
    if (s->saturated) {
        print_warning("%" PRIu64 " contributions were brighter than the film holds and were "
                      "clipped",
                      s->saturated);
    }
    if (s->checkpoint_problem[0]) {
        print_warning("the checkpoint could not be written: %s", s->checkpoint_problem);
    }
    if (s->dropped_nesting) {
        print_warning("%" PRIu64 " times more transparent objects were inside each other than are "
                      "kept track of",
                      s->dropped_nesting);
    }
}

static json_t *rays_json(uint64_t traced, uint64_t hit)
{
    return json_pack("{s:I, s:I}", "traced", (json_int_t)traced, "hit", (json_int_t)hit);
}

static json_t *layers_json(const lr_layers *layers)
{
    json_t *names = json_array();
    for (uint32_t i = 0; i < layers->count; i++) {
        json_array_append_new(names, json_string(layers->layers[i].name));
    }
    return names;
}

static json_t *record_json(const render_record *r)
{
    const lr_render_stats *s = &r->stats;
    /* Paths may hold bytes that are not UTF-8, which JSON cannot: such a path becomes null. */
    json_t *scene = json_string(r->scene), *output = json_string(r->output);
    json_t *camera = r->camera ? json_string(r->camera) : NULL;
    json_t *device =
        json_pack("{s:s, s:s, s:s, s:b, s:b}", "name", r->device.name, "driver", r->device.driver,
                  "api_version", format_version(r->device.api_version).text, "software",
                  r->device.software, "exact", r->exact);
    json_t *picture =
        json_pack("{s:i, s:i, s:[i,i], s:s, s:i, s:i, s:I, s:f, s:s, s:s}", "width", (int)r->width,
                  "height", (int)r->height, "full_size", (int)s->width, (int)s->height,
                  "integrator", s->integrator == LR_INTEGRATOR_PATH ? "path" : "whitted", "samples",
                  (int)s->samples, "depth", (int)s->depth, "seed", (json_int_t)s->seed, "exposure",
                  r->exposure, "tone", r->tone, "sha256", s->hash);
    if (r->white != 0) {
        json_object_set_new(picture, "white", json_real(r->white));
    }
    if (s->least_samples < s->most_samples) {
        json_object_set_new(picture, "samples_traced",
                            json_pack("{s:f, s:I, s:I}", "mean", s->mean_samples, "least",
                                      (json_int_t)s->least_samples, "most",
                                      (json_int_t)s->most_samples));
    }
    if (s->sample_count < s->samples) {
        json_object_set_new(picture, "sample_range",
                            json_pack("[I,I]", (json_int_t)s->first_sample,
                                      (json_int_t)s->first_sample + s->sample_count - 1));
    }
    if (layer_count(r)) {
        json_object_set_new(picture, "layers", layers_json(r->layers));
    }
    if (r->denoiser) {
        json_object_set_new(picture, "denoised",
                            json_pack("{s:s, s:s, s:f}", "by", r->denoiser, "sha256",
                                      r->denoised_hash, "seconds", r->denoise_seconds));
    }
    json_t *rays = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:I}", "primary", rays_json(s->primary.traced, s->primary.hit),
        "reflected", rays_json(s->reflected.traced, s->reflected.hit), "refracted",
        rays_json(s->refracted.traced, s->refracted.hit), "bounced",
        rays_json(s->bounced.traced, s->bounced.hit), "shadow",
        rays_json(s->shadow.traced, s->shadow.hit), "total", (json_int_t)rays_traced(s));
    json_t *dropped =
        json_pack("{s:I, s:I, s:I}", "depth", (json_int_t)s->dropped_depth, "weight",
                  (json_int_t)s->dropped_weight, "nesting", (json_int_t)s->dropped_nesting);
    json_t *cpu_seconds =
        json_pack("{s:f, s:f, s:f, s:f, s:f}", "build", s->build_cpu_seconds, "upload",
                  s->upload_cpu_seconds, "compile", s->compile_cpu_seconds, "trace",
                  s->trace_cpu_seconds, "total", (double)clock() / CLOCKS_PER_SEC);
    json_t *seconds = json_pack(
        "{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "device", r->device_seconds, "parse",
        r->parse_seconds, "build", s->build_seconds, "upload", s->upload_seconds, "compile",
        s->compile_seconds, "trace", s->trace_seconds, "read_back", s->read_back_seconds, "write",
        r->write_seconds, "total", r->total_seconds, "longest_pass", s->longest_pass_seconds);
    json_object_set_new(rays, "resumed", json_real(s->resumed));
    if (layer_count(r)) {
        json_object_set_new(seconds, "layers", json_real(s->layers_seconds));
    }
    return json_pack(
        "{s:s, s:o*, s:o*, s:o*, s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:f, s:o, s:o, s:I}", "version",
        LR_VERSION, "scene", scene, "output", output, "camera", camera, "device", device, "picture",
        picture, "rays", rays, "dropped", dropped, "passed", (json_int_t)s->passed, "non_finite",
        (json_int_t)s->non_finite, "saturated", (json_int_t)s->saturated, "rays_per_second",
        rays_per_second(s), "seconds", seconds, "cpu_seconds", cpu_seconds, "peak_memory_bytes",
        (json_int_t)peak_memory());
}

int write_record(const render_record *r, const char *path)
{
    return write_json(record_json(r), path);
}
