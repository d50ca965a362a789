#include "cli/aov.h"
#include "cli/cli.h"
#include "cli/encoding.h"
#include "cli/frames.h"
#include "cli/load.h"
#include "cli/output.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "cli/stats.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct values {
    const char *stats, *checkpoint, *aov, *frames;
    encoding_values encoding;
    picture_values picture;
    option_rectangle crop;
    option_range sample_range;
    double checkpoint_seconds, time, noise;
    int64_t tile, chunk;
    load_values load;
    uint32_t aovs; /* those of --aov, a bit for each */
    bool storage_loads, quiet, verbose;
} values;

#define AT(member) .offset = offsetof(values, member)

static const option options[] = {
    OUTPUT_OPTIONS(values),
    PICTURE_OPTIONS(values),
    ENCODING_OPTIONS(values),
    {.name = "crop",
     .kind = OPTION_RECTANGLE,
     AT(crop),
     .value = "X,Y,W,H",
     .min = 1,
     .max = 32768,
     .help = "render and write only this part of the picture, in\n"
             "pixels from its top left corner",
     .also = "region|window"},
    {.name = "frames",
     .kind = OPTION_TEXT,
     AT(frames),
     .value = "A-B",
     .help = "render these frames, each to a file of its own:\n"
             "-o frame-%04d.png; or to standard output, one PPM or\n"
             "PNG behind the other, as video encoders read them",
     .also = "animation|range"},
    {.name = "sample-range",
     .kind = OPTION_RANGE,
     AT(sample_range),
     .value = "A-B",
     .min = 0,
     .max = 65535,
     .help = "trace only samples A to B, the first being 0, and\n"
             "write a part: an EXR file for lavaray merge",
     .also = "part|range"},
    {.name = "time",
     .kind = OPTION_DURATION,
     AT(time),
     .value = "TIME",
     .max = 31536000,
     .help = "as many samples as fit in 500ms, 60s, 10m, 2h, ..., at\n"
             "least 1 and at most --spp; for --integrator path",
     .also = "seconds|limit|timeout"},
    {.name = "noise",
     .kind = OPTION_REAL,
     AT(noise),
     .value = "X",
     .min = 0,
     .max = 1,
     .help = "no more samples where the noise is below X: 0.01 is\n"
             "about one of 255 shades; at most --spp; for paths",
     .also = "adaptive|threshold|error"},
    {.name = "checkpoint",
     .kind = OPTION_TEXT,
     AT(checkpoint),
     .value = "FILE",
     .help = "keep what is traced in FILE, every 30 seconds and when\n"
             "interrupted; the same command goes on from there",
     .also = "resume|continue|save"},
    {.name = "aov",
     .kind = OPTION_TEXT,
     AT(aov),
     .value = "LIST",
     .help = "more layers of an EXR file, with commas between: all,\n"
             "or albedo, normal, depth, position, alpha, id, direct,\n"
             "indirect, variance, samples",
     .also = "aovs|layers|passes|channels"},
    {.name = "stats",
     .kind = OPTION_TEXT,
     AT(stats),
     .value = "FILE",
     .help = "write statistics as JSON; \"-\" is standard output"},
    LOAD_OPTIONS(values),
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     AT(quiet),
     .help = "no progress, no summary: only warnings and errors",
     .also = "silent"},
    {.name = "verbose",
     .letter = 'v',
     .kind = OPTION_FLAG,
     AT(verbose),
     .help = "a longer summary"},
    {.name = "tile",
     .kind = OPTION_INTEGER,
     AT(tile),
     .value = "N",
     .min = 1,
     .max = 32768,
     .help = "pixels along a tile's side",
     .for_tests = true},
    {.name = "chunk",
     .kind = OPTION_INTEGER,
     AT(chunk),
     .value = "N",
     .min = 1,
     .max = 1 << 30,
     .help = "rays handed to the device at once",
     .for_tests = true},
    {.name = "checkpoint-seconds",
     .kind = OPTION_REAL,
     AT(checkpoint_seconds),
     .value = "S",
     .min = 0,
     .max = 86400,
     .help = "between two checkpoints, at least",
     .for_tests = true},
    {.name = "storage-loads",
     .kind = OPTION_FLAG,
     AT(storage_loads),
     .help = "read the scene through storage buffers",
     .for_tests = true},
};

/* A part has its own format, and is no picture yet. */
static int check_part(const command *self, const values *v, const lr_encoding *encoding)
{
    if (encoding->format != LR_FORMAT_EXR) {
        return wrong_usage(self, "--sample-range writes a part, which is an EXR file: -o FILE.exr");
    }
    const encoding_values *e = &v->encoding;
    if (e->half || e->transfer || !isnan(e->exposure) || e->look.tone || e->look.white != 0 ||
        e->look.denoise) {
        return wrong_usage(self,
                           "--sample-range writes exact sums: how they become a picture is for "
                           "lavaray merge to say");
    }
    return EXIT_FINE;
}

static int check_aov(const command *self, const values *v, const lr_encoding *encoding)
{
    if (encoding->format != LR_FORMAT_EXR) {
        return wrong_usage(self, "--aov writes layers, which only EXR files have: -o FILE.exr");
    }
    if (v->sample_range.given || v->checkpoint) {
        return wrong_usage(self, "--aov goes with neither --sample-range nor --checkpoint");
    }
    return EXIT_FINE;
}

/* What goes with --frames. */
static int check_several(const command *self, const values *v, const lr_encoding *encoding)
{
    if (v->load.frame) {
        return wrong_usage(self, "--frame is for a single picture, --frames for several");
    }
    if (v->stats) {
        return wrong_usage(self, "--stats tells of a single picture, not of --frames");
    }
    if (v->checkpoint) {
        return wrong_usage(self, "--checkpoint is for a single picture, not for --frames");
    }
    return check_frames(self, v->frames, v->encoding.output, encoding->format);
}

/* What the flags mean together, and whether the files can be written. */
static int check_values(const command *self, const values *v, const char *scene,
                        lr_encoding *encoding)
{
    if (v->quiet && v->verbose) {
        return wrong_usage(self, "-q and -v contradict each other");
    }
    int code = choose_encoding(self, &v->encoding, encoding);
    if (code == EXIT_FINE && v->aov) {
        code = check_aov(self, v, encoding);
    }
    if (code == EXIT_FINE && v->sample_range.given) {
        code = check_part(self, v, encoding);
    }
    if (code == EXIT_FINE) {
        code = check_names(self, v->encoding.output, v->stats, v->checkpoint, scene);
    }
    if (code == EXIT_FINE) {
        code = v->frames ? check_several(self, v, encoding) : check_writable(v->encoding.output);
    }
    if (code == EXIT_FINE && v->stats) {
        code = check_writable(v->stats);
    }
    return code == EXIT_FINE && v->checkpoint ? check_writable(v->checkpoint) : code;
}

static lr_render_options make_options(const values *v, progress *p)
{
    lr_render_options made = picture_options(&v->picture);
    made.crop.x = v->crop.x;
    made.crop.y = v->crop.y;
    made.crop.width = v->crop.width;
    made.crop.height = v->crop.height;
    if (v->sample_range.given) {
        made.sample_range.first = v->sample_range.first;
        made.sample_range.count = v->sample_range.last - v->sample_range.first + 1;
    }
    made.seconds = v->time;
    made.noise = v->noise;
    made.checkpoint = v->checkpoint;
    made.checkpoint_seconds = v->checkpoint_seconds;
    made.tile_size = (uint32_t)v->tile;
    made.chunk_rays = (uint32_t)v->chunk;
    made.storage_loads = v->storage_loads;
    made.progress = progress_update;
    made.user = p;
    return made;
}

/* problem: why the checkpoint could not be written, ""; NULL: nothing has been traced yet. */
static int say_interrupted(const values *v, const char *problem)
{
    if (v->frames) {
        print_error("interrupted in frame %d, which is not written", (int)v->load.frame);
    } else if (problem && problem[0]) {
        print_error("interrupted, and the checkpoint could not be written: %s", problem);
    } else if (problem && v->checkpoint && access(v->checkpoint, F_OK) == 0) {
        print_error("interrupted; %s holds what has been traced, the same command goes on from it",
                    v->checkpoint);
    } else {
        print_error("interrupted, nothing written");
    }
    return EXIT_INTERRUPTED;
}

/* Writes the picture, unless it is a part, which is written already. */
static int write_result(const values *v, lr_encoding encoding, const lr_picture *picture,
                        render_record *record)
{
    double start = seconds_now();
    const picture_origin origin = {
        .scene_hash = record->scene_hash,
        .settings = record->stats.settings,
        .pixel_hash = record->denoiser ? record->denoised_hash : record->stats.hash,
        .denoiser = record->denoiser,
        .frame = (unsigned)v->load.frame,
    };
    encoding.layers = record->layers->layers;
    encoding.layer_count = record->layers->count;
    int code = v->sample_range.given
                   ? EXIT_FINE
                   : write_picture(picture, v->encoding.output, encoding, &origin);
    if (code == EXIT_FINE && v->checkpoint) {
        unlink(v->checkpoint); /* it may never have been written */
    }
    record->width = v->crop.width ? v->crop.width : record->stats.width;
    record->height = v->crop.height ? v->crop.height : record->stats.height;
    record->write_seconds = seconds_now() - start;
    return code;
}

/* Traces and writes; fills what record does not hold yet. */
static int trace_and_write(const values *v, lr_device *device, lr_denoiser *denoiser,
                           const lr_scene *scene, const lr_encoding *encoding, progress *p,
                           double start, render_record *record)
{
    lr_error error = {0};
    lr_picture picture = {0};
    lr_layers layers = {.count = 0};
    lr_render_options wanted = make_options(v, p);
    lr_status status;
    progress_phase(p, "building and compiling");
    if (v->sample_range.given) {
        status = lr_render_part(device, scene, &wanted, v->encoding.output, &record->stats, &error);
    } else if (v->aovs) {
        status = lr_render_layers(device, scene, &wanted, v->aovs, &picture, &layers,
                                  &record->stats, &error);
    } else {
        status = lr_render(device, scene, &wanted, &picture, &record->stats, &error);
    }
    record->layers = &layers;
    if (status == LR_OK) {
        status = denoise_picture(denoiser, &picture, p, record, &error);
    }
    progress_clear(p);
    int code;
    if (status == LR_ERROR_INTERRUPTED ||
        (status == LR_OK && interrupted() && !v->sample_range.given)) {
        code = say_interrupted(v, record->stats.checkpoint_problem);
        goto done;
    }
    if (status != LR_OK) {
        error.status = status;
        code = report_failure(&error);
        goto done;
    }
    /* Before the picture is written: one that a driver complained about is not worth keeping. */
    code = check_validation(device, EXIT_FINE);
    if (code == EXIT_FINE) {
        code = write_result(v, *encoding, &picture, record);
    }
    if (code != EXIT_FINE) {
        goto done;
    }
    record->total_seconds = seconds_now() - start;
    print_record_warnings(record);
    if (v->verbose) {
        print_record(record);
    } else if (!v->quiet) {
        print_record_line(record);
    }
    code = v->stats ? write_record(record, v->stats) : EXIT_FINE;
done:
    lr_picture_free(&picture);
    lr_layers_free(&layers);
    return code;
}

/* What lasts from the first frame to the last. */
typedef struct job {
    values v;
    const char *path; /* the scene's */
    lr_encoding encoding;
    progress progress;
    lr_device *device;
    lr_denoiser *denoiser; /* NULL: not asked for */
    double device_seconds;
} job;

static int open_device(job *j)
{
    lr_error error = {0};
    if (j->v.encoding.look.denoise && lr_denoiser_open(&j->denoiser, &error)) {
        progress_clear(&j->progress);
        return report_failure(&error);
    }
    progress_phase(&j->progress, "opening device");
    double start = seconds_now();
    lr_device_desc desc = {.select = j->v.picture.device, .validation = validation_wanted()};
    lr_status status = lr_device_open(&desc, &j->device, &error);
    j->device_seconds = seconds_now() - start;
    if (status == LR_OK) {
        return EXIT_FINE;
    }
    progress_clear(&j->progress);
    error.status = status;
    return report_failure(&error);
}

/* One picture, from the scene's text to the file. *scene is that of the picture before, or NULL,
 * and becomes that of this one. */
static int render_picture(job *j, double start, lr_scene **scene)
{
    const values *v = &j->v;
    progress_phase(&j->progress, "reading scene");
    render_record record = {
        .scene = j->path, .output = v->encoding.output, .camera = v->picture.camera};
    lr_scene_info scene_info;
    lr_scene *previous = *scene;
    load_values load = v->load;
    load.previous = previous;
    int code = load_scene(j->path, &load, v->quiet || previous, scene, &j->progress);
    lr_scene_destroy(previous);
    record.parse_seconds = seconds_now() - start;
    if (code != EXIT_FINE) {
        *scene = NULL;
        return code;
    }
    if (interrupted()) {
        progress_clear(&j->progress);
        return say_interrupted(v, NULL);
    }
    lr_scene_get_info(*scene, &scene_info);
    if (v->frames && !previous && !scene_info.moves && !v->quiet) {
        progress_clear(&j->progress);
        print_warning("nothing in %s has keys: all frames are the same", j->path);
    }
    record.scene_hash = scene_info.sha256;
    record.exposure =
        isnan(v->encoding.exposure) ? (double)scene_info.exposure : v->encoding.exposure;
    lr_encoding encoding = j->encoding;
    finish_encoding(&v->encoding, &scene_info, &encoding);
    record.tone = lr_tone_name(encoding.tone);
    record.white = encoding.white;
    code = j->device ? EXIT_FINE : open_device(j);
    if (code != EXIT_FINE) {
        return code;
    }
    record.device_seconds = j->device_seconds;
    record.device = *lr_device_get_info(j->device);
    record.exact = lr_device_is_exact(j->device);
    return trace_and_write(v, j->device, j->denoiser, *scene, &encoding, &j->progress, start,
                           &record);
}

static int render_frames(job *j, lr_scene **scene)
{
    frame_range range;
    char path[PATH_MAX];
    const char *pattern = j->v.encoding.output;
    bool to_stdout = strcmp(pattern, "-") == 0;
    int code = EXIT_FINE;
    frames_parse(j->v.frames, &range);
    for (uint32_t frame = range.first; frame <= range.last && code == EXIT_FINE; frame++) {
        j->v.load.frame = frame;
        if (!to_stdout) {
            frames_path(pattern, frame, path, sizeof path);
            j->v.encoding.output = path;
        }
        if (same_file(j->v.encoding.output, j->path)) {
            print_error("%s: the output would replace the scene", j->v.encoding.output);
            return EXIT_USAGE;
        }
        code = render_picture(j, seconds_now(), scene);
    }
    return code;
}

static int run(const command *self, int argc, char **argv)
{
    double start = seconds_now();
    job j = {.v = {.picture = PICTURE_DEFAULTS, .encoding = ENCODING_DEFAULTS}};
    const values *v = &j.v;
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &j.v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    j.path = argv[0];
    int code = check_values(self, v, j.path, &j.encoding);
    if (code == EXIT_FINE && v->aov) {
        code = parse_aovs(self, v->aov, &j.v.aovs);
    }
    if (code != EXIT_FINE) {
        return code;
    }
    if (v->frames && strcmp(j.path, "-") == 0) {
        return wrong_usage(self, "--frames reads the scene once a frame: give a file, not -");
    }
    catch_interrupts();
    progress_start(&j.progress, v->quiet);
    lr_scene *scene = NULL;
    code = v->frames ? render_frames(&j, &scene) : render_picture(&j, start, &scene);
    lr_denoiser_close(j.denoiser);
    lr_device_close(j.device);
    lr_scene_destroy(scene);
    return code;
}

const command command_render = {
    .name = "render",
    .operands = "SCENE -o FILE",
    .summary = "render a scene to a picture",
    .details = "Renders SCENE and writes the picture. SCENE is YAML or JSON (\"-\" is standard\n"
               "input), or a .gltf, .glb, .obj, .ply, .stl or .nff file. The picture depends on\n"
               "the scene and the flags alone, not on the device. When the render fails or is\n"
               "interrupted nothing is written but the checkpoint.",
    .examples = "  lavaray render scenes/showcase.yaml -o showcase.png\n"
                "  lavaray render room.yaml -o room.exr --size 1920x1080 --spp 64 --device gpu\n"
                "  lavaray render room.yaml -o - | pnmtopng > room.png\n"
                "  lavaray render room.yaml -o a.exr --spp 64 --sample-range 0-31\n"
                "  lavaray render turn.yaml --frames 0-47 -o turn-%04d.png",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
