#include "tester/command.h"

#include "base/memory.h"
#include "tester/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Takes over the word, NULL when memory was out. */
static bool add(lr_command *c, char *word)
{
    if (!word ||
        !lr_array_reserve((void **)&c->words, c->count + 1, &c->capacity, sizeof *c->words)) {
        free(word);
        return false;
    }
    c->words[c->count++] = word;
    c->words[c->count] = NULL;
    return true;
}

static bool add_text(lr_command *c, const char *text)
{
    return add(c, lr_string_copy(text, strlen(text)));
}

static bool add_flag(lr_command *c, const char *flag, const char *value)
{
    return add_text(c, flag) && add_text(c, value);
}

static bool add_number(lr_command *c, const char *flag, uint32_t value)
{
    return add_text(c, flag) && add(c, lr_format_text("%u", value));
}

/* A path that no program takes for a flag. */
static char *plain_path(const char *path)
{
    return lr_format_text("%s%s", path[0] == '-' ? "./" : "", path);
}

static bool make_render(lr_command *c, const lr_case *item, const lr_run_options *options,
                        const char *program, const char *output, const char *stats)
{
    const lr_case_settings *s = &item->settings;
    const char *device = s->device ? s->device : options->device;
    bool good = add_text(c, program) && add_text(c, "render") && add(c, plain_path(item->scene)) &&
                add_text(c, "-o") && add(c, plain_path(output));
    if (stats)
        good = good && add_text(c, "-q") && add_flag(c, "--stats", stats);
    if (s->size)
        good = good && add_flag(c, "--size", s->size);
    if (s->has_samples)
        good = good && add_number(c, "--spp", s->samples);
    if (s->has_depth)
        good = good && add_number(c, "--depth", s->depth);
    if (s->has_seed)
        good = good && add_number(c, "--seed", s->seed);
    if (device)
        good = good && add_flag(c, "--device", device);
    for (uint32_t i = 0; i < s->args_count; i++)
        good = good && add_text(c, s->args[i]);
    return good;
}

/* The text with {output}, {scene} and {name} filled in; other braces stay. */
static char *fill_in(const char *text, const lr_case *item, const char *output)
{
    const struct {
        const char *name, *value;
    } places[] = {
        {"{output}", output}, {"{scene}", item->scene ? item->scene : ""}, {"{name}", item->name}};
    char *filled = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&filled, &size);
    if (!out)
        return NULL;
    while (*text) {
        size_t taken = 0;
        for (size_t i = 0; i < sizeof places / sizeof *places && !taken; i++)
            if (strncmp(text, places[i].name, strlen(places[i].name)) == 0) {
                fputs(places[i].value, out);
                taken = strlen(places[i].name);
            }
        if (!taken)
            fputc(*text, out);
        text += taken ? taken : 1;
    }
    if (fclose(out) == 0)
        return filled;
    free(filled);
    return NULL;
}

bool lr_command_make(lr_command *command, const lr_case *item, const lr_run_options *options,
                     const char *program, const char *output, const char *stats)
{
    const lr_case_settings *s = &item->settings;
    *command = (lr_command){0};
    bool good = true;
    if (!s->run)
        good = make_render(command, item, options, program, output, stats);
    for (uint32_t i = 0; i < s->run_count; i++)
        good = good && add(command, fill_in(s->run[i], item, output));
    if (!good)
        lr_command_free(command);
    return good;
}

void lr_command_free(lr_command *command)
{
    for (uint32_t i = 0; i < command->count; i++)
        free(command->words[i]);
    free(command->words);
    *command = (lr_command){0};
}
