/* Scenes made by importers, element by element. */
#ifndef LR_SCENE_BUILD_H
#define LR_SCENE_BUILD_H

#include "scene/report.h"
#include "scene/scene.h"

/* Makes a scene of a text: `read` fills it in and reports what is wrong, to which the text, its
 * name and its language are known; options, which may be NULL, are passed on. Returns as
 * lr_scene_parse does. */
lr_status lr_scene_from_text(const char *text, size_t length, const char *name,
                             const lr_language *language, const lr_load_options *options,
                             void (*read)(lr_scene *scene, lr_report *report,
                                          const lr_load_options *options),
                             lr_scene **scene, char **report, lr_error *error);

/* A scene that grows, with the room that its arrays have. */
typedef struct lr_scene_builder {
    lr_scene *scene;
    const lr_scene *beside;    /* NULL, or the scene that this one goes into: limits are for both */
    const lr_scene *donors[2]; /* NULL, or scenes whose parts may be shared, */
    bool trusting;             /* ... even if their files have changed since */
    uint32_t camera_capacity, material_capacity, object_capacity, light_capacity;
    uint32_t mesh_capacity, texture_capacity, note_capacity, part_capacity;
} lr_scene_builder;

/* Each appends one zeroed element and returns it, NULL when memory is out. The scene owns what the
 * element then points to. Valid until the next call for the same array. */
lr_camera *lr_scene_add_camera(lr_scene_builder *builder);
lr_material *lr_scene_add_material(lr_scene_builder *builder);
lr_object *lr_scene_add_object(lr_scene_builder *builder);
lr_light *lr_scene_add_light(lr_scene_builder *builder);
lr_mesh *lr_scene_add_mesh(lr_scene_builder *builder);
lr_texture *lr_scene_add_texture(lr_scene_builder *builder);

/* Notes what an import left out and why. False when memory is out. */
bool lr_scene_add_note(lr_scene_builder *builder, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
