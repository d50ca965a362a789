#include "cli/aov.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 40 };

static bool find_aov(const char *name, uint32_t *wanted)
{
    if (strcmp(name, "all") == 0) {
        *wanted = (1u << LR_AOV_COUNT) - 1;
        return true;
    }
    for (uint32_t i = 0; i < LR_AOV_COUNT; i++) {
        if (strcmp(name, lr_aov_name(i)) == 0) {
            *wanted |= 1u << i;
            return true;
        }
    }
    return false;
}

static void say_unknown(const command *self, const char *name)
{
    unsigned distance = UINT_MAX;
    const char *best = nearest_name(name, "all", NULL, &distance);
    char known[200] = "";
    for (uint32_t i = 0; i < LR_AOV_COUNT; i++) {
        best = nearest_name(name, lr_aov_name(i), best, &distance);
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s, ", lr_aov_name(i));
    }
    if (best) {
        print_error("--aov: unknown layer '%s', did you mean %s? See lavaray %s --help", name, best,
                    self->name);
    } else {
        print_error("--aov: unknown layer '%s'; there are %sor all of them: all", name, known);
    }
}

int parse_aovs(const command *self, const char *text, uint32_t *wanted)
{
    *wanted = 0;
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ",");
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "%.*s", (int)(length < NAME_SIZE ? length : NAME_SIZE), at);
        if (!find_aov(name, wanted)) {
            say_unknown(self, name);
            return EXIT_USAGE;
        }
        at += length;
        if (!*at) {
            return EXIT_FINE;
        }
    }
}
