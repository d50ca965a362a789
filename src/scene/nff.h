/* The Neutral File Format of the Standard Procedural Databases (Eric Haines, "A Proposal for
 * Standard Graphics Environments", IEEE CG&A 7(11), 1987). */
#ifndef LR_SCENE_NFF_H
#define LR_SCENE_NFF_H

#include "lavaray.h"

#define LR_NFF_TEXT_MAX ((size_t)1 << 30) /* bytes */

/* Whether the path ends in .nff, in capitals or not. */
bool lr_nff_is_path(const char *path);

/* As lr_scene_parse, of a text in NFF; docs/nff.md says what becomes of each element. */
lr_status lr_nff_read(const char *text, size_t length, const char *name, lr_scene **scene,
                      char **report, lr_error *error);

#endif
