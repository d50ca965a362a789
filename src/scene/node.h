/* The YAML text as a tree of positioned nodes. libfyaml parses; what our languages do not
 * allow (tags, merge keys, several documents, duplicate keys, endless nesting) is refused here. */
#ifndef LR_SCENE_NODE_H
#define LR_SCENE_NODE_H

#include "scene/report.h"

#define LR_TEXT_MAX (16u << 20) /* bytes of a scene text */
#define LR_NODES_MAX 1000000    /* values, aliases counted as often as they are used */
#define LR_NESTING_MAX 128      /* levels of lists and mappings */
#define LR_FLOW_LINE_MAX 500000 /* commas and brackets on one line; see lr_text_check */

typedef enum lr_node_kind {
    LR_NODE_EMPTY,  /* nothing, null or ~ */
    LR_NODE_PLAIN,  /* text without quotes: a number, a word */
    LR_NODE_QUOTED, /* text in quotes or a block scalar */
    LR_NODE_LIST,
    LR_NODE_MAP,
} lr_node_kind;

typedef struct lr_node lr_node;
struct lr_node {
    lr_node_kind kind;
    uint32_t offset;     /* where it starts in the text; of an empty value: its key or dash */
    uint32_t line;       /* from 1 */
    uint32_t size;       /* nodes below and including it, through aliases */
    uint32_t count;      /* bytes of text, items of a list, pairs of a map */
    uint32_t start, end; /* the bytes that stand for it here, without its anchor: where it is an
                            alias, that one's and not the value's, which `offset` and `line` tell */
    union {
        const char *text;      /* NUL-terminated, may hold further NULs */
        const lr_node **items; /* a map's are key, value, key, value, ... */
    };
};

typedef struct lr_chunk lr_chunk;

/* Owns the memory of all nodes. */
typedef struct lr_tree {
    lr_chunk *chunks;
    const lr_node *root;
} lr_tree;

/* Reads report->text into tree->root. Errors go to the report; root is NULL when there is nothing
 * to go on with, and errors may have been reported when it is not. */
void lr_tree_read(lr_tree *tree, lr_report *report);
void lr_tree_free(lr_tree *tree);

static inline const lr_node *lr_map_key(const lr_node *map, uint32_t index)
{
    return map->items[2 * index];
}

static inline const lr_node *lr_map_value(const lr_node *map, uint32_t index)
{
    return map->items[2 * index + 1];
}

/* Checks what libfyaml should not be given: sizes, control characters, broken UTF-8. False after
 * reporting why. */
bool lr_text_check(lr_report *report);

/* Reports libfyaml's syntax error, at line and column from 1 (0 when unknown), as what the author
 * most likely did wrong. */
void lr_syntax_error(lr_report *report, int line, int column, const char *message);

#endif
