/* The header of PLY files: which elements follow, and what their rows hold. */
#include "scene/import_ply.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static lr_status header_error(reader *r, const char *what)
{
    return lr_fail(r->import->error, LR_ERROR_FILE, "%s: header of PLY: %s", r->import->shown,
                   what);
}

/* The next line without its end and the spaces around it; what is longer is cut. */
static bool next_line(reader *r, char line[LINE_MAX_LENGTH + 1])
{
    const char *bytes = r->import->bytes;
    size_t used = 0;
    if (r->at >= r->import->size)
        return false;
    for (; r->at < r->import->size && bytes[r->at] != '\n' && bytes[r->at] != '\r'; r->at++)
        if (used < LINE_MAX_LENGTH)
            line[used++] = bytes[r->at];
    if (r->at + 1 < r->import->size && bytes[r->at] == '\r' && bytes[r->at + 1] == '\n')
        r->at++;
    r->at++;
    while (used > 0 && isspace((unsigned char)line[used - 1]))
        used--;
    line[used] = 0;
    return true;
}

static bool find_type(const char *name, ply_type *type)
{
    static const char *const names[TYPES][2] = {
        {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
        {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
    for (int i = 0; i < TYPES; i++)
        if (strcmp(name, names[i][0]) == 0 || strcmp(name, names[i][1]) == 0) {
            *type = (ply_type)i;
            return true;
        }
    return false;
}

static slot find_slot(const char *name)
{
    static const struct {
        const char *name;
        slot slot;
    } names[] = {{"x", X},
                 {"y", Y},
                 {"z", Z},
                 {"nx", NX},
                 {"ny", NY},
                 {"nz", NZ},
                 {"u", U},
                 {"v", V},
                 {"s", U},
                 {"t", V},
                 {"texture_u", U},
                 {"texture_v", V},
                 {"red", RED},
                 {"green", GREEN},
                 {"blue", BLUE},
                 {"diffuse_red", RED},
                 {"r", RED},
                 {"g", GREEN},
                 {"b", BLUE},
                 {"diffuse_green", GREEN},
                 {"diffuse_blue", BLUE}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i].name) == 0)
            return names[i].slot;
    return OTHER;
}

static lr_status read_property(reader *r, const char *line)
{
    char type[32], count_type[32], name[32];
    if (r->element_count == 0)
        return header_error(r, "a property before the first element");
    element *e = &r->elements[r->element_count - 1];
    if (e->property_count == PROPERTIES_MAX)
        return header_error(r, "an element has over 64 properties");
    property *p = &e->properties[e->property_count++];
    *p = (property){.slot = OTHER};
    if (sscanf(line, "property list %31s %31s %31s", count_type, type, name) == 3) {
        p->is_list = true;
        if (!find_type(count_type, &p->count_type) || p->count_type >= FLOAT32)
            return header_error(r, "the length of a list has no integer type");
        p->is_corners = strcmp(e->name, "face") == 0 &&
                        (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0);
    } else if (sscanf(line, "property %31s %31s", type, name) != 2) {
        return header_error(r, "a property that is not understood");
    }
    if (!find_type(type, &p->type))
        return header_error(r, "a property of an unknown type");
    if (!p->is_list && strcmp(e->name, "vertex") == 0) {
        p->slot = find_slot(name);
        if (p->slot != OTHER)
            r->has[p->slot] = true;
    }
    return LR_OK;
}

static lr_status read_element(reader *r, const char *line)
{
    unsigned long long count;
    if (r->element_count == ELEMENTS_MAX)
        return header_error(r, "over 16 kinds of elements");
    element *e = &r->elements[r->element_count++];
    *e = (element){0};
    if (strchr(line, '-') || sscanf(line, "element %31s %llu", e->name, &count) != 2)
        return header_error(r, "an element that is not understood");
    e->count = count;
    return LR_OK;
}

static lr_status check(reader *r, bool has_format)
{
    if (!has_format)
        return header_error(r, "no format");
    return r->has[X] && r->has[Y] && r->has[Z] ? LR_OK
                                               : header_error(r, "its vertices have no x, y and z");
}

lr_status lr_ply_read_header(reader *r)
{
    char line[LINE_MAX_LENGTH + 1], format[32];
    bool has_format = false;
    if (!next_line(r, line) || strcmp(line, "ply") != 0)
        return lr_fail(r->import->error, LR_ERROR_FILE,
                       "%s: is no PLY file: it does not begin as one", r->import->shown);
    while (next_line(r, line)) {
        lr_status status = LR_OK;
        if (strcmp(line, "end_header") == 0)
            return check(r, has_format);
        if (sscanf(line, "format %31s", format) == 1) {
            has_format = true;
            if (strcmp(format, "ascii") == 0)
                r->format = TEXT;
            else if (strcmp(format, "binary_little_endian") == 0)
                r->format = LITTLE;
            else if (strcmp(format, "binary_big_endian") == 0)
                r->format = BIG;
            else
                return header_error(r, "an unknown format");
        } else if (strncmp(line, "element ", 8) == 0) {
            status = read_element(r, line);
        } else if (strncmp(line, "property ", 9) == 0) {
            status = read_property(r, line);
        }
        if (status)
            return status;
    }
    return header_error(r, "it has no end");
}
