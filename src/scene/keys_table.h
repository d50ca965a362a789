/* What the tables of keys are written with. */
#ifndef LR_SCENE_KEYS_TABLE_H
#define LR_SCENE_KEYS_TABLE_H

#include "scene/keys.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))
#define MEMBER(type, member) .offset = offsetof(type, member)
#define RANGE(low, high) .minimum = (low), .maximum = (high)
#define LENGTH RANGE(LR_LENGTH_MIN, LR_COORDINATE_MAX)
#define COORDINATE RANGE(-LR_COORDINATE_MAX, LR_COORDINATE_MAX)
#define COLOR RANGE(0, LR_COLOR_MAX)
#define DEFAULT(...) .fallback = {__VA_ARGS__}
#define RECORD(name_, doc_, fields_, kind_)                                                        \
    {                                                                                              \
        .name = (name_), .doc = (doc_), .fields = (fields_), .count = COUNT(fields_),              \
        .kind = (kind_)                                                                            \
    }

/* `doc` ends up in editors and in docs/scene.md: one sentence, in plain words. A field without a
 * default needs LR_REQUIRED or LR_DERIVED; the order is that of the documentation. */

#endif
