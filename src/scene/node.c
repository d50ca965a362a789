#include "scene/node.h"

#include "base/memory.h"
#include "scene/names.h"

#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>

/* Nodes and their text are never freed one by one, so they come from large chunks. */
#define CHUNK_SIZE 65536

struct lr_chunk {
    lr_chunk *next;
    size_t used, size;
    max_align_t data[];
};

static void *tree_alloc(lr_tree *tree, size_t size)
{
    size = (size + sizeof(max_align_t) - 1) / sizeof(max_align_t) * sizeof(max_align_t);
    lr_chunk *chunk = tree->chunks;
    if (!chunk || chunk->size - chunk->used < size) {
        size_t room = size > CHUNK_SIZE ? size : CHUNK_SIZE;
        chunk = lr_alloc(1, sizeof *chunk + room);
        if (!chunk)
            return NULL;
        *chunk = (lr_chunk){.next = tree->chunks, .size = room};
        tree->chunks = chunk;
    }
    void *memory = (char *)chunk->data + chunk->used;
    chunk->used += size;
    return memory;
}

void lr_tree_free(lr_tree *tree)
{
    while (tree->chunks) {
        lr_chunk *next = tree->chunks->next;
        free(tree->chunks);
        tree->chunks = next;
    }
    tree->root = NULL;
}

/* A list or map whose end has not come yet; its children wait on the builder's pending stack. */
typedef struct frame {
    lr_node *node;
    const char *anchor; /* NULL: none */
    size_t anchor_length;
    uint32_t first; /* child on the pending stack */
} frame;

typedef struct builder {
    lr_tree *tree;
    lr_report *report;
    frame frames[LR_NESTING_MAX];
    uint32_t depth;
    const lr_node **pending;
    uint32_t pending_count, pending_capacity;
    lr_names anchors; /* to indices of anchored */
    const lr_node **anchored;
    uint32_t anchored_count, anchored_capacity;
    uint32_t nodes, documents;
    uint32_t last_offset, last_line; /* where the latest token ended */
    bool stopped;
} builder;

static void stop(builder *b)
{
    b->stopped = true;
}

static void out_of_memory(builder *b)
{
    b->report->no_memory = true;
    stop(b);
}

static lr_node *new_node(builder *b, lr_node_kind kind, const struct fy_mark *start)
{
    lr_node *node = tree_alloc(b->tree, sizeof *node);
    if (!node) {
        out_of_memory(b);
        return NULL;
    }
    *node = (lr_node){.kind = kind, .size = 1};
    node->offset = start ? (uint32_t)start->input_pos : b->last_offset;
    node->line = start ? (uint32_t)start->line + 1 : b->last_line;
    if (++b->nodes > LR_NODES_MAX) {
        lr_report_add(b->report, node->offset, "the %s has more than %d values; %s",
                      b->report->language->subject, LR_NODES_MAX, b->report->language->relief);
        stop(b);
    }
    return node;
}

/* Lets the anchor's name mean the node from here on. */
static void set_anchor(builder *b, const lr_node *node, const char *name, size_t length)
{
    if (!name)
        return;
    if (!lr_array_reserve((void **)&b->anchored, b->anchored_count, &b->anchored_capacity,
                          sizeof *b->anchored) ||
        !lr_names_put(&b->anchors, name, length, b->anchored_count)) {
        out_of_memory(b);
        return;
    }
    b->anchored[b->anchored_count++] = node;
}

static void push(builder *b, const lr_node *node)
{
    if (b->depth == 0) {
        b->tree->root = node;
        return;
    }
    if (!lr_array_reserve((void **)&b->pending, b->pending_count, &b->pending_capacity,
                          sizeof *b->pending)) {
        out_of_memory(b);
        return;
    }
    b->pending[b->pending_count++] = node;
}

/* The key that the next pushed node is the value of, NULL when it is none. */
static const lr_node *waiting_key(const builder *b)
{
    if (b->depth == 0)
        return NULL;
    const frame *top = &b->frames[b->depth - 1];
    bool is_value = (b->pending_count - top->first) % 2 == 1;
    return top->node->kind == LR_NODE_MAP && is_value ? b->pending[b->pending_count - 1] : NULL;
}

/* Walks the pieces of a token's text, copying them to `out` unless it is NULL. Returns their total
 * length. fy_token_get_text() of libfyaml 0.7.12 leaks for quoted text of more than ten pieces
 * ('''''''''''''''''''''''' is one); its iterator does not. */
static size_t walk_text(struct fy_token *token, char *out, bool *failed)
{
    struct fy_token_iter *iterator = fy_token_iter_create(token);
    if (!iterator) {
        *failed = true;
        return 0;
    }
    size_t length = 0;
    int broken = 0;
    const struct fy_iter_chunk *chunk = NULL;
    while ((chunk = fy_token_iter_chunk_next(iterator, chunk, &broken)) != NULL) {
        if (out)
            memcpy(out + length, chunk->str, chunk->len);
        length += chunk->len;
    }
    fy_token_iter_destroy(iterator);
    *failed |= broken != 0;
    return length;
}

static const char *copy_text(builder *b, struct fy_token *token, size_t *length)
{
    bool failed = false;
    *length = token ? walk_text(token, NULL, &failed) : 0;
    char *copy = failed ? NULL : tree_alloc(b->tree, *length + 1);
    if (!copy) {
        out_of_memory(b);
        return NULL;
    }
    if (*length)
        walk_text(token, copy, &failed);
    copy[*length] = '\0';
    return copy;
}

static bool is_null(const char *text)
{
    return !*text || !strcmp(text, "~") || !strcmp(text, "null") || !strcmp(text, "Null") ||
           !strcmp(text, "NULL");
}

/* An empty value has no position of its own: it gets its key's, or that of the dash or comma that
 * it stands behind. */
static void place_empty(builder *b, lr_node *node)
{
    const lr_node *key = waiting_key(b);
    if (key) {
        node->offset = key->offset;
        node->line = key->line;
        return;
    }
    const char *text = b->report->text;
    size_t offset = b->last_offset;
    bool comment = false;
    for (; offset < b->report->length; offset++) {
        char c = text[offset];
        if (c == '\n') {
            comment = false;
            node->line++;
        } else if (c == '#') {
            comment = true;
        } else if (!comment && c != ' ' && c != '\t' && c != '\r') {
            break;
        }
    }
    node->offset = (uint32_t)offset;
}

/* 0 behind the end of the text. */
static char byte_at(const builder *b, size_t offset)
{
    return offset < b->report->length ? b->report->text[offset] : 0;
}

/* From its opening to its closing quote; what is not there has no bytes. */
static void place_scalar(const builder *b, lr_node *node, struct fy_token *token)
{
    const struct fy_mark *end = token ? fy_token_end_mark(token) : NULL;
    node->start = token ? node->offset : b->last_offset;
    node->end = end ? (uint32_t)end->input_pos : node->start;
    char quote = byte_at(b, node->start);
    bool quoted = node->kind == LR_NODE_QUOTED && (quote == '"' || quote == '\'');
    if (quoted && byte_at(b, node->end) == quote)
        node->end++;
}

static void add_scalar(builder *b, struct fy_event *event, const char *anchor, size_t anchor_length)
{
    struct fy_token *token = event->scalar.value;
    const struct fy_mark *start = token ? fy_token_start_mark(token) : NULL;
    lr_node *node = new_node(b, LR_NODE_PLAIN, start);
    if (!node)
        return;
    size_t length = 0;
    node->text = copy_text(b, token, &length);
    if (!node->text)
        return;
    node->count = (uint32_t)length;
    if (token && fy_token_scalar_style(token) != FYSS_PLAIN) {
        node->kind = LR_NODE_QUOTED;
        /* The mark stands behind the opening quote. */
        char before = node->offset > 0 ? b->report->text[node->offset - 1] : 0;
        if (before == '"' || before == '\'')
            node->offset--;
    } else if (is_null(node->text)) {
        node->kind = LR_NODE_EMPTY;
    }
    if (!start)
        place_empty(b, node);
    place_scalar(b, node, start ? token : NULL);
    push(b, node);
    set_anchor(b, node, anchor, anchor_length);
}

static void add_alias(builder *b, struct fy_event *event)
{
    size_t length = 0;
    const char *name = copy_text(b, event->alias.anchor, &length);
    if (!name)
        return;
    const struct fy_mark *start = fy_token_start_mark(event->alias.anchor);
    size_t offset = start && start->input_pos > 0 ? start->input_pos - 1 : 0; /* the asterisk */
    uint32_t index;
    char shown[LR_SHOWN_MAX];
    if (lr_names_get(&b->anchors, name, length, &index)) {
        lr_node *node = tree_alloc(b->tree, sizeof *node);
        if (!node) {
            out_of_memory(b);
            return;
        }
        *node = *b->anchored[index];
        node->start = (uint32_t)offset;
        node->end = (uint32_t)(offset + 1 + length);
        push(b, node);
        return;
    }
    bool inside = false;
    for (uint32_t i = 0; i < b->depth; i++) {
        const frame *f = &b->frames[i];
        inside |= f->anchor && f->anchor_length == length && !memcmp(f->anchor, name, length);
    }
    if (inside)
        lr_report_add(b->report, offset, "alias *%s stands inside the value it repeats",
                      lr_shown(shown, name, length));
    else
        lr_report_add(b->report, offset, "alias *%s has no anchor &%s above it",
                      lr_shown(shown, name, length), lr_shown(shown, name, length));
    /* What the alias was to be is unknown: any tree would bring errors of its own. */
    stop(b);
}

static void open_frame(builder *b, lr_node_kind kind, struct fy_event *event, const char *anchor,
                       size_t anchor_length)
{
    lr_node *node = new_node(b, kind, fy_event_start_mark(event));
    if (!node)
        return;
    if (b->depth == LR_NESTING_MAX) {
        lr_report_add(b->report, node->offset, "lists and mappings nest more than %d levels deep",
                      LR_NESTING_MAX);
        stop(b);
        return;
    }
    b->frames[b->depth++] = (frame){node, anchor, anchor_length, b->pending_count};
}

/* Whether the pair belongs in the map; if not, why not is reported. */
static bool check_key(builder *b, const lr_node *key, lr_names *seen, const lr_node **children,
                      uint32_t index)
{
    char shown[LR_SHOWN_MAX];
    if (key->kind == LR_NODE_LIST || key->kind == LR_NODE_MAP || key->kind == LR_NODE_EMPTY) {
        lr_report_add(b->report, key->offset, "this key is %s, expected a name",
                      key->kind == LR_NODE_LIST  ? "a list"
                      : key->kind == LR_NODE_MAP ? "a mapping"
                                                 : "empty");
        return false;
    }
    if (key->kind == LR_NODE_PLAIN && !strcmp(key->text, "<<")) {
        lr_report_add(b->report, key->offset,
                      "merge keys (<<) are not part of YAML 1.2; write the keys out");
        return false;
    }
    uint32_t first;
    if (lr_names_get(seen, key->text, key->count, &first)) {
        lr_report_add(b->report, key->offset, "duplicate key \"%s\", first given on line %u",
                      lr_shown(shown, key->text, key->count), children[first]->line);
        return false;
    }
    if (!lr_names_put(seen, key->text, key->count, index))
        out_of_memory(b);
    return true;
}

static void close_frame(builder *b, struct fy_event *event)
{
    frame top = b->frames[--b->depth];
    lr_node *node = top.node;
    const lr_node **children = b->pending ? b->pending + top.first : NULL;
    uint32_t count = b->pending_count - top.first;
    node->items = tree_alloc(b->tree, count * sizeof *node->items);
    if (!node->items) {
        out_of_memory(b);
        return;
    }
    /* Children are complete and carry their own sizes, so an alias is counted without walking it
     * again; a bomb is noticed at the first value that is too large. */
    uint64_t size = 1;
    if (node->kind == LR_NODE_LIST) {
        for (uint32_t i = 0; i < count; i++) {
            node->items[node->count++] = children[i];
            size += children[i]->size;
        }
    } else {
        lr_names seen = {0};
        for (uint32_t i = 0; i + 1 < count && !b->stopped; i += 2) {
            if (!check_key(b, children[i], &seen, children, i))
                continue;
            node->items[2 * node->count] = children[i];
            node->items[2 * node->count + 1] = children[i + 1];
            node->count++;
            size += 1 + children[i + 1]->size;
        }
        lr_names_free(&seen);
    }
    /* The end of one without brackets is noticed only at what follows. */
    char bracket = byte_at(b, node->offset);
    const struct fy_mark *end = fy_event_end_mark(event);
    bool flow = (bracket == '[' || bracket == '{') && end;
    node->start = node->offset;
    node->end = flow ? (uint32_t)end->input_pos : count ? children[count - 1]->end : node->start;
    node->size = size > LR_NODES_MAX ? LR_NODES_MAX + 1 : (uint32_t)size;
    b->pending_count = top.first;
    if (size > LR_NODES_MAX) {
        lr_report_add(b->report, node->offset, "aliases expand this to more than %d values",
                      LR_NODES_MAX);
        stop(b);
        return;
    }
    push(b, node);
    set_anchor(b, node, top.anchor, top.anchor_length);
}

static void refuse_tag(builder *b, struct fy_event *event)
{
    struct fy_token *tag = fy_event_get_tag_token(event);
    if (!tag)
        return;
    const struct fy_mark *start = fy_token_start_mark(tag);
    lr_report_add(b->report, start ? start->input_pos : b->last_offset,
                  "tags (!name) are not part of the %s language; remove it",
                  b->report->language->subject);
}

static void take_event(builder *b, struct fy_event *event)
{
    const char *anchor = NULL;
    size_t anchor_length = 0;
    if (event->type == FYET_SCALAR || event->type == FYET_SEQUENCE_START ||
        event->type == FYET_MAPPING_START) {
        refuse_tag(b, event);
        struct fy_token *token = fy_event_get_anchor_token(event);
        if (token)
            anchor = copy_text(b, token, &anchor_length);
    }
    switch (event->type) {
    case FYET_DOCUMENT_START:
        if (++b->documents == 2) {
            const struct fy_mark *mark = fy_event_start_mark(event);
            lr_report_add(b->report, mark ? mark->input_pos : b->last_offset,
                          "a second document starts here, expected one %s in a file",
                          b->report->language->subject);
            stop(b);
        }
        break;
    case FYET_SCALAR:
        add_scalar(b, event, anchor, anchor_length);
        break;
    case FYET_ALIAS:
        add_alias(b, event);
        break;
    case FYET_SEQUENCE_START:
        open_frame(b, LR_NODE_LIST, event, anchor, anchor_length);
        break;
    case FYET_MAPPING_START:
        open_frame(b, LR_NODE_MAP, event, anchor, anchor_length);
        break;
    case FYET_SEQUENCE_END:
    case FYET_MAPPING_END:
        close_frame(b, event);
        break;
    default:
        break;
    }
    const struct fy_mark *end = fy_event_end_mark(event);
    if (end) {
        b->last_offset = (uint32_t)end->input_pos;
        b->last_line = (uint32_t)end->line + 1;
    }
}

static void report_syntax_error(lr_report *report, struct fy_diag *diag)
{
    void *iterator = NULL;
    const struct fy_diag_error *error = fy_diag_errors_iterate(diag, &iterator);
    while (error && error->type != FYET_ERROR)
        error = fy_diag_errors_iterate(diag, &iterator);
    if (error)
        lr_syntax_error(report, error->line, error->column, error->msg);
    else
        lr_syntax_error(report, 0, 0, "unreadable YAML");
}

void lr_tree_read(lr_tree *tree, lr_report *report)
{
    *tree = (lr_tree){0};
    builder b = {.tree = tree, .report = report, .last_line = 1};
    struct fy_parser *parser = NULL;
    /* Without an output function the library writes nothing; errors are collected. */
    struct fy_diag_cfg diag_cfg;
    fy_diag_cfg_default(&diag_cfg);
    diag_cfg.fp = NULL;
    diag_cfg.colorize = false;
    struct fy_diag *diag = fy_diag_create(&diag_cfg);
    if (!diag) {
        report->no_memory = true;
        return;
    }
    fy_diag_set_collect_errors(diag, true);
    struct fy_parse_cfg cfg = {
        .flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG | FYPCF_JSON_NONE | FYPCF_DEFAULT_VERSION_1_2 |
                 FYPCF_SLOPPY_FLOW_INDENTATION,
        .diag = diag,
    };
    parser = fy_parser_create(&cfg);
    if (!parser || fy_parser_set_string(parser, report->text, report->length) != 0) {
        report->no_memory = true;
    } else {
        struct fy_event *event;
        while (!b.stopped && (event = fy_parser_parse(parser)) != NULL) {
            take_event(&b, event);
            fy_parser_event_free(parser, event);
        }
        if (!b.stopped && fy_parser_get_stream_error(parser)) {
            report_syntax_error(report, diag);
            b.stopped = true;
        }
    }
    fy_parser_destroy(parser);
    fy_diag_destroy(diag);
    free(b.pending);
    free(b.anchored);
    lr_names_free(&b.anchors);
    if (b.stopped)
        tree->root = NULL;
    else if (!tree->root && !lr_report_failed(report))
        lr_report_add(report, 0, "the file holds no %s, expected keys such as %s",
                      report->language->subject, report->language->examples);
}
