/* Scenes as text: what the writers of the languages share. */
#ifndef LR_SCENE_WRITE_H
#define LR_SCENE_WRITE_H

#include "scene/color.h"
#include "scene/scene.h"

#include <stdio.h>

#define LR_WRITER_NOTES_MAX 32

/* What a language cannot say, and how often it was asked to. */
typedef struct lr_writer_note {
    const char *text;
    uint32_t count;
} lr_writer_note;

typedef struct lr_writer {
    FILE *out; /* memory; its failures are found when it is closed */
    const lr_scene *scene;
    const char *path; /* where the text will go */
    lr_scene_format format;
    lr_writer_note notes[LR_WRITER_NOTES_MAX];
    uint32_t note_count;
    char names[32]; /* how the names of materials without one begin: no other begins so */
} lr_writer;

/* Write the whole scene to writer->out. */
void lr_write_yaml(lr_writer *writer);
void lr_write_povray(lr_writer *writer);
void lr_write_tachyon(lr_writer *writer);

/* What `put` writes about something, in the C locale: a text of *length bytes that the caller
 * frees; NULL when memory is out. */
char *lr_written(void (*put)(FILE *out, void *something), void *something, size_t *length);

/* The camera as a mapping in braces. */
void lr_put_camera(FILE *out, const lr_camera *camera);

/* The camera as a line to paste into a scene: `camera: {...}`, or with a name as an entry below
 * `cameras:`. The caller frees it; NULL when memory is out. */
char *lr_camera_text(const lr_camera *camera);

/* Counts something that the language cannot say. The same text counts together. */
void lr_writer_cannot(lr_writer *writer, const char *text);

/* The shortest decimal number that is read back as the same double or float. */
void lr_put_number(FILE *out, double value);
void lr_put_float(FILE *out, float value);

/* Numbers between commas. */
void lr_put_numbers(FILE *out, const double *values, uint32_t count);
void lr_put_floats(FILE *out, const float *values, uint32_t count);

/* A line "MARK from NAME, written by lavaray VERSION", where no name can end the line. */
void lr_put_origin(const lr_writer *writer, const char *mark);

bool lr_color_is_grey(lr_color color);
double lr_color_greatest(lr_color color);

/* Right-handed: along the view, to the right and up, each of unit length; *half_height is that of
 * the picture at distance 1, from the middle to its edge. */
void lr_camera_frame(const lr_scene *scene, const lr_camera *camera, lr_vec3 *forward,
                     lr_vec3 *right, lr_vec3 *up, double *half_height);

/* A file beside path: "out-1.ply" for "out.yaml", number 0 and ".ply". Returns buffer, or NULL when
 * it does not fit. */
const char *lr_side_path(const char *path, uint32_t number, const char *ending, char *buffer,
                         size_t size);

/* The ending of a texture's file, such as ".png"; NULL when it was not loaded from one. */
const char *lr_texture_ending(const lr_texture *texture);

/* The mesh as a binary PLY file of *size bytes, which the caller frees; NULL when memory is out. */
char *lr_mesh_ply(const lr_mesh *mesh, size_t *size);

#endif
