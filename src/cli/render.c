#include "cli/cli.h"
#include "cli/frames.h"
#include "cli/load.h"
#include "cli/look.h"
#include "cli/output.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "cli/stats.h"
#include "image/image.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct values {
    const char *output, *format, *transfer, *stats, *frames;
    int64_t maxval;  /* -1: not given */
    double exposure; /* NaN: not given */
    picture_values picture;
    option_rectangle crop;
    int64_t tile, chunk;
    load_values load;
    look_values look;
    bool half, storage_loads, quiet, verbose;
} values;

#define AT(member) .offset = offsetof(values, member)

static const option options[] = {
    {.name = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     AT(output),
     .value = "FILE",
     .help = "the picture, in the format of its ending: .ppm, .png,\n"
             ".pfm or .exr (linear floats); \"-\" is standard output",
     .also = "out|file"},
    {.name = "format",
     .kind = OPTION_CHOICE,
     AT(format),
     .value = "FORMAT",
     .choices = "ppm|png|pfm|exr",
     .help = "ppm, png, pfm or exr, whatever the name ends in;\n"
             "default for standard output: ppm",
     .also = "type"},
    PICTURE_OPTIONS(values),
    {.name = "maxval",
     .kind = OPTION_INTEGER,
     AT(maxval),
     .value = "N",
     .min = 1,
     .max = 65535,
     .help = "the value of white: 1 to 65535 for PPM, 255 or 65535\nfor PNG; default: 255",
     .also = "bits|bit-depth"},
    {.name = "transfer",
     .kind = OPTION_CHOICE,
     AT(transfer),
     .value = "CURVE",
     .choices = "srgb|linear",
     .help = "srgb (default) or linear; PFM and EXR are linear",
     .also = "gamma"},
    {.name = "half",
     .kind = OPTION_FLAG,
     AT(half),
     .help = "16-bit floats in EXR; default: 32 bits, exact",
     .also = "float|exr"},
    {.name = "exposure",
     .kind = OPTION_REAL,
     AT(exposure),
     .value = "EV",
     .min = -64,
     .max = 64,
     .help = "stops, -64 to 64; 1 is twice as bright;\ndefault: the scene's"},
    LOOK_OPTIONS(values),
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
    {.name = "storage-loads",
     .kind = OPTION_FLAG,
     AT(storage_loads),
     .help = "read the scene through storage buffers",
     .for_tests = true},
};

static lr_format format_named(const char *name)
{
    char path[16];
    lr_format format = LR_FORMAT_PPM;
    snprintf(path, sizeof path, ".%s", name);
    lr_format_from_path(path, &format);
    return format;
}

/* What the flags mean together, and whether the files can be written. */
static int check_values(const command *self, const values *v, const char *scene,
                        lr_encoding *encoding)
{
    if (!v->output) {
        return wrong_usage(self, "where to? Give -o FILE.png, .ppm, .pfm or .exr");
    }
    bool to_stdout = strcmp(v->output, "-") == 0;
    frame_range range;
    if (v->frames && !frames_parse(v->frames, &range)) {
        print_error("--frames must be A-B, such as 0-47, from 0 to %d, not '%.100s'; see lavaray "
                    "render --help",
                    FRAME_MAX, v->frames);
        return EXIT_USAGE;
    }
    if (v->frames && !to_stdout && !frames_named(v->output)) {
        return wrong_usage(self, "with --frames the output needs one number: -o frame-%04d.png");
    }
    if (v->frames && v->load.frame) {
        return wrong_usage(self, "--frame is for a single picture, --frames for several");
    }
    if (v->frames && v->stats) {
        return wrong_usage(self, "--stats tells of a single picture, not of --frames");
    }
    encoding->format = LR_FORMAT_PPM;
    if (v->format) {
        encoding->format = format_named(v->format);
    } else if (!to_stdout && !lr_format_from_path(v->output, &encoding->format)) {
        print_error("%s: the name must end in .ppm, .png, .pfm or .exr; see lavaray render --help",
                    v->output);
        return EXIT_USAGE;
    }
    if (to_stdout && isatty(STDOUT_FILENO)) {
        return wrong_usage(self, "-o - is for pipes and files, standard output is a terminal");
    }
    if (to_stdout && v->stats && strcmp(v->stats, "-") == 0) {
        return wrong_usage(self, "-o - and --stats - cannot both have standard output");
    }
    if (v->quiet && v->verbose) {
        return wrong_usage(self, "-q and -v contradict each other");
    }
    bool floats = encoding->format == LR_FORMAT_PFM || encoding->format == LR_FORMAT_EXR;
    if (floats && v->maxval >= 0) {
        return wrong_usage(self, "--maxval means nothing for PFM and EXR, which hold floats");
    }
    if (floats && v->transfer && strcmp(v->transfer, "srgb") == 0) {
        return wrong_usage(self, "--transfer srgb is not for PFM and EXR, which are always linear");
    }
    if (v->frames && to_stdout && floats) {
        return wrong_usage(self, "frames go to standard output as PPM or PNG");
    }
    if (check_look(self, &v->look, encoding->format) != EXIT_FINE) {
        return EXIT_USAGE;
    }
    if (v->half && encoding->format != LR_FORMAT_EXR) {
        return wrong_usage(self, "--half is for EXR alone");
    }
    if (encoding->format == LR_FORMAT_PNG && v->maxval >= 0 && v->maxval != 255 &&
        v->maxval != 65535) {
        return wrong_usage(self, "--maxval must be 255 or 65535 for PNG");
    }
    if (same_file(v->output, scene) || (v->stats && same_file(v->stats, scene))) {
        return wrong_usage(self, "the output would replace the scene");
    }
    if (v->stats && strcmp(v->stats, v->output) == 0) {
        return wrong_usage(self, "the picture and the statistics have the same name");
    }
    char path[PATH_MAX];
    if (v->frames && !(frames_path(v->output, range.last, path, sizeof path) &&
                       frames_path(v->output, range.first, path, sizeof path))) {
        print_error("%.100s: the path is too long", v->output);
        return EXIT_FILE;
    }
    int code = check_writable(v->frames ? path : v->output);
    return code == EXIT_FINE && v->stats ? check_writable(v->stats) : code;
}

static lr_render_options make_options(const values *v, progress *p)
{
    lr_render_options made = picture_options(&v->picture);
    made.crop.x = v->crop.x;
    made.crop.y = v->crop.y;
    made.crop.width = v->crop.width;
    made.crop.height = v->crop.height;
    made.tile_size = (uint32_t)v->tile;
    made.chunk_rays = (uint32_t)v->chunk;
    made.storage_loads = v->storage_loads;
    made.progress = progress_update;
    made.user = p;
    return made;
}

static int say_interrupted(const values *v)
{
    if (v->frames) {
        print_error("interrupted in frame %d, which is not written", (int)v->load.frame);
    } else {
        print_error("interrupted, nothing written");
    }
    return EXIT_INTERRUPTED;
}

/* "640x480, 4 samples, depth 6, seed 0" and what else the pixels depend on, as the picture's file
 * says it. */
static void describe_settings(const values *v, const lr_encoding *encoding,
                              const render_record *record, char *text, size_t size)
{
    const lr_render_stats *s = &record->stats;
    FILE *out = fmemopen(text, size, "w");
    if (!out) {
        text[0] = '\0';
        return;
    }
    fprintf(out, "%s%ux%u, %u sample%s, depth %u, seed %u",
            s->integrator == LR_INTEGRATOR_PATH ? "paths, " : "", (unsigned)s->width,
            (unsigned)s->height, (unsigned)s->samples, s->samples == 1 ? "" : "s",
            (unsigned)s->depth, (unsigned)s->seed);
    if (v->crop.width) {
        fprintf(out, ", crop %u,%u,%u,%u", (unsigned)v->crop.x, (unsigned)v->crop.y,
                (unsigned)v->crop.width, (unsigned)v->crop.height);
    }
    if (v->picture.camera) {
        fprintf(out, ", camera %.200s", v->picture.camera);
    }
    if (v->picture.filter) {
        fprintf(out, ", filter %s", v->picture.filter);
    }
    if (v->load.frame) {
        fprintf(out, ", frame %d", (int)v->load.frame);
    }
    if (encoding->exposure != 0) {
        fprintf(out, ", exposure %.7g", (double)encoding->exposure);
    }
    describe_look(encoding, out);
    if (record->denoiser) {
        fprintf(out, ", denoised by %s", record->denoiser);
    }
    if (encoding->format == LR_FORMAT_PNG && encoding->transfer == LR_TRANSFER_LINEAR) {
        fputs(", linear", out);
    }
    fclose(out);
}

/* Traces and writes; fills what record does not hold yet. */
static int trace_and_write(const values *v, lr_device *device, lr_denoiser *denoiser,
                           const lr_scene *scene, lr_encoding encoding, progress *p, double start,
                           render_record *record)
{
    lr_error error = {0};
    lr_picture picture = {0};
    lr_render_options render_options = make_options(v, p);
    progress_phase(p, "building and compiling");
    lr_status status = lr_render(device, scene, &render_options, &picture, &record->stats, &error);
    if (status == LR_OK) {
        status = denoise_picture(denoiser, &picture, p, record, &error);
    }
    progress_clear(p);
    int code;
    if (status == LR_ERROR_INTERRUPTED || (status == LR_OK && interrupted())) {
        code = say_interrupted(v);
        goto done;
    }
    if (status != LR_OK) {
        error.status = status;
        code = report_failure(&error);
        goto done;
    }
    /* Before the picture is written: one that a driver complained about is not worth keeping. */
    code = check_validation(device, EXIT_FINE);
    if (code != EXIT_FINE) {
        goto done;
    }
    char settings[512];
    describe_settings(v, &encoding, record, settings, sizeof settings);
    const lr_text texts[] = {
        {LR_STAMP_SOFTWARE, "lavaray " LR_VERSION},
        {LR_STAMP_SCENE, record->scene_hash},
        {LR_STAMP_SETTINGS, settings},
        {LR_STAMP_PIXELS, record->denoiser ? record->denoised_hash : record->stats.hash},
    };
    encoding.texts = texts;
    encoding.text_count = sizeof texts / sizeof *texts;
    double write_start = seconds_now();
    status = lr_picture_write(&picture, v->output, &encoding, &error);
    if (status != LR_OK) {
        error.status = status;
        code = report_failure(&error);
        goto done;
    }
    record->width = picture.width;
    record->height = picture.height;
    record->write_seconds = seconds_now() - write_start;
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
    if (j->v.look.denoise && lr_denoiser_open(&j->denoiser, &error)) {
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
    render_record record = {.scene = j->path, .output = v->output, .camera = v->picture.camera};
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
        return say_interrupted(v);
    }
    lr_scene_get_info(*scene, &scene_info);
    if (v->frames && !previous && !scene_info.moves && !v->quiet) {
        progress_clear(&j->progress);
        print_warning("nothing in %s has keys: all frames are the same", j->path);
    }
    record.scene_hash = scene_info.sha256;
    record.exposure = isnan(v->exposure) ? (double)scene_info.exposure : v->exposure;
    lr_encoding encoding = j->encoding;
    encoding.exposure = (float)record.exposure;
    choose_look(&v->look, &scene_info, &encoding);
    record.tone = lr_tone_name(encoding.tone);
    record.white = encoding.white;
    code = j->device ? EXIT_FINE : open_device(j);
    if (code != EXIT_FINE) {
        return code;
    }
    record.device_seconds = j->device_seconds;
    record.device = *lr_device_get_info(j->device);
    record.exact = lr_device_is_exact(j->device);
    return trace_and_write(v, j->device, j->denoiser, *scene, encoding, &j->progress, start,
                           &record);
}

static int render_frames(job *j, lr_scene **scene)
{
    frame_range range;
    char path[PATH_MAX];
    const char *pattern = j->v.output;
    bool to_stdout = strcmp(pattern, "-") == 0;
    int code = EXIT_FINE;
    frames_parse(j->v.frames, &range);
    for (uint32_t frame = range.first; frame <= range.last && code == EXIT_FINE; frame++) {
        j->v.load.frame = frame;
        if (!to_stdout) {
            frames_path(pattern, frame, path, sizeof path);
            j->v.output = path;
        }
        if (same_file(j->v.output, j->path)) {
            print_error("%s: the output would replace the scene", j->v.output);
            return EXIT_USAGE;
        }
        code = render_picture(j, seconds_now(), scene);
    }
    return code;
}

static int run(const command *self, int argc, char **argv)
{
    double start = seconds_now();
    job j = {.v = {.picture = PICTURE_DEFAULTS, .maxval = -1, .exposure = NAN}};
    const values *v = &j.v;
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &j.v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    j.path = argv[0];
    int code = check_values(self, v, j.path, &j.encoding);
    if (code != EXIT_FINE) {
        return code;
    }
    if (v->frames && strcmp(j.path, "-") == 0) {
        return wrong_usage(self, "--frames reads the scene once a frame: give a file, not -");
    }
    j.encoding.maxval = v->maxval >= 0 ? (uint32_t)v->maxval : 0;
    j.encoding.transfer =
        v->transfer && strcmp(v->transfer, "linear") == 0 ? LR_TRANSFER_LINEAR : LR_TRANSFER_SRGB;
    j.encoding.half = v->half;
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
               "the scene and the flags alone, not on the device. Nothing is written when the\n"
               "render fails or is interrupted.",
    .examples = "  lavaray render scenes/showcase.yaml -o showcase.png\n"
                "  lavaray render room.yaml -o room.exr --size 1920x1080 --spp 64 --device gpu\n"
                "  lavaray render room.yaml -o - | pnmtopng > room.png\n"
                "  lavaray render turn.yaml --frames 0-47 -o - | ffmpeg -f image2pipe -framerate "
                "24 -i - turn.mp4",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
