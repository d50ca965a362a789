#include "tester/suite.h"

#include "base/file.h"
#include "base/memory.h"
#include "scene/names.h"
#include "tester/listing.h"
#include "tester/settings.h"
#include "tester/text.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

static const char *const scene_endings[] = {"yaml", "yml", "json", NULL};
static const char *const picture_endings[] = {"png", "exr", "pfm", "ppm", "pgm",
                                              "pnm", "pbm", "hdr", NULL};

struct lr_suite_store {
    lr_settings settings;
    char *path, *text; /* of tests.yaml */
    char *scene_folder;
};

typedef struct loader {
    const lr_suite_desc *desc;
    lr_suite *suite;
    lr_settings *settings;
    lr_report *report; /* of tests.yaml */
    lr_names names;    /* of the cases, to their indices */
    uint32_t capacity, orphan_capacity;
    lr_error *error;
} loader;

static lr_status out_of_memory(loader *l)
{
    return lr_fail(l->error, LR_ERROR_MEMORY, "out of memory for the test cases");
}

static lr_case *find_case(const loader *l, const char *name)
{
    uint32_t index;
    return lr_names_get(&l->names, name, strlen(name), &index) ? &l->suite->cases[index] : NULL;
}

/* NULL when memory is out. */
static lr_case *add_case(loader *l, const char *name, size_t length)
{
    lr_suite *suite = l->suite;
    char *copy = lr_string_copy(name, length);
    if (!copy ||
        !lr_array_reserve((void **)&suite->cases, suite->count, &l->capacity,
                          sizeof *suite->cases) ||
        !lr_names_put(&l->names, copy, length, suite->count)) {
        free(copy);
        return NULL;
    }
    lr_case *item = &suite->cases[suite->count++];
    *item = (lr_case){.name = copy, .settings = l->settings->defaults};
    return item;
}

static lr_status read_settings(loader *l)
{
    struct lr_suite_store *store = l->suite->store;
    const char *given = l->desc->settings;
    store->path =
        given ? lr_string_copy(given, strlen(given)) : lr_join_path(l->suite->folder, "tests.yaml");
    if (!store->path)
        return out_of_memory(l);
    l->report->name = store->path;
    l->report->language = &lr_settings_language;
    if (!given && !lr_is_file(store->path))
        return LR_OK;
    lr_status status =
        lr_file_read(store->path, LR_TEXT_MAX, &store->text, &l->report->length, l->error);
    l->report->text = store->text;
    if (status == LR_OK)
        lr_settings_read(l->settings, l->report);
    return status;
}

/* ---- A folder of scenes and goldens -------------------------------------------------------- */

static lr_status list_scenes(loader *l)
{
    struct lr_suite_store *store = l->suite->store;
    lr_listing scenes = {0};
    char *inner = lr_join_path(l->suite->folder, "scenes");
    if (!inner)
        return out_of_memory(l);
    bool deep = lr_is_folder(inner);
    if (!deep) {
        free(inner);
        inner = lr_string_copy(l->suite->folder, strlen(l->suite->folder));
    }
    store->scene_folder = inner;
    lr_status status =
        inner ? lr_listing_read(&scenes, inner, scene_endings, deep, l->error) : out_of_memory(l);
    for (uint32_t i = 0; status == LR_OK && i < scenes.count; i++) {
        const char *path = scenes.paths[i];
        size_t length = lr_stem_length(path);
        char *full = lr_join_path(inner, path);
        uint32_t index;
        if (!full) {
            status = out_of_memory(l);
        } else if (strcmp(path, "tests.yaml") == 0) {
            free(full);
        } else if (lr_names_get(&l->names, path, length, &index)) {
            status = lr_fail(l->error, LR_ERROR_FILE,
                             "%.400s and %.400s: two scenes for one case; rename one of them",
                             l->suite->cases[index].scene, full);
            free(full);
        } else {
            lr_case *item = add_case(l, path, length);
            if (item)
                item->scene = full;
            else
                free(full);
            status = item ? LR_OK : out_of_memory(l);
        }
    }
    lr_listing_free(&scenes);
    return status;
}

static void report_no_scene(loader *l, const lr_named_settings *named)
{
    lr_nearest nearest = {.text = named->name, .length = strlen(named->name)};
    for (uint32_t i = 0; i < l->suite->count; i++)
        lr_nearest_offer(&nearest, l->suite->cases[i].name);
    if (nearest.best)
        lr_report_add(l->report, named->offset, "no scene is called \"%s\"; did you mean \"%s\"?",
                      named->name, nearest.best);
    else
        lr_report_add(l->report, named->offset,
                      "no scene is called \"%s\" in %s, and the case has neither scene nor run",
                      named->name, l->suite->store->scene_folder);
}

/* The settings of single cases, which may be cases of their own. */
static lr_status apply_named(loader *l)
{
    uint32_t scene_count = l->suite->count;
    for (uint32_t i = 0; i < l->settings->count; i++) {
        const lr_named_settings *named = &l->settings->cases[i];
        const lr_case_settings *s = &named->settings;
        lr_case *item = find_case(l, named->name);
        bool of_scene = item && item - l->suite->cases < scene_count;
        if (!item && !s->scene && !s->has_run) {
            report_no_scene(l, named);
            continue;
        }
        if (!item)
            item = add_case(l, named->name, strlen(named->name));
        if (!item)
            return out_of_memory(l);
        item->settings = *s;
        if (of_scene && s->scene)
            lr_report_add(l->report, named->offset,
                          "\"%s\" is the name of a scene, so this case needs another name",
                          named->name);
        else if (s->scene && !(item->scene = lr_join_path(l->suite->folder, s->scene)))
            return out_of_memory(l);
    }
    return LR_OK;
}

/* The golden that is there, or where it will be. */
static lr_status find_golden(loader *l, lr_case *item, const char *folder)
{
    const lr_case_settings *s = &item->settings;
    for (int i = 0; picture_endings[i] && !s->has_format; i++) {
        char *path = lr_format_text("%s/%s.%s", folder, item->name, picture_endings[i]);
        if (!path)
            return out_of_memory(l);
        if (!lr_is_file(path)) {
            free(path);
        } else if (item->golden) {
            lr_status status =
                lr_fail(l->error, LR_ERROR_FILE,
                        "%.400s and %.400s: two goldens for one case; delete one of them, or set "
                        "the format of the case",
                        item->golden, path);
            free(path);
            return status;
        } else {
            item->golden = path;
        }
    }
    if (!item->golden)
        item->golden = lr_format_text("%s/%s.%s", folder, item->name, lr_test_formats[s->format]);
    return item->golden ? LR_OK : out_of_memory(l);
}

/* Goldens that no case is compared with. */
static lr_status find_orphans(loader *l, const char *folder)
{
    lr_suite *suite = l->suite;
    lr_names goldens = {0};
    lr_listing found = {0};
    lr_status status = LR_OK;
    for (uint32_t i = 0; i < suite->count; i++)
        if (!lr_names_put(&goldens, suite->cases[i].golden, strlen(suite->cases[i].golden), i))
            status = out_of_memory(l);
    if (status == LR_OK && lr_is_folder(folder))
        status = lr_listing_read(&found, folder, picture_endings, true, l->error);
    for (uint32_t i = 0; status == LR_OK && i < found.count; i++) {
        uint32_t index;
        char *path = lr_format_text("%s/%s", folder, found.paths[i]);
        if (!path || !lr_array_reserve((void **)&suite->orphans, suite->orphan_count,
                                       &l->orphan_capacity, sizeof *suite->orphans))
            status = out_of_memory(l);
        if (status != LR_OK || lr_names_get(&goldens, path, strlen(path), &index))
            free(path);
        else
            suite->orphans[suite->orphan_count++] = path;
    }
    lr_listing_free(&found);
    lr_names_free(&goldens);
    return status;
}

static lr_status load_folder(loader *l)
{
    lr_status status = list_scenes(l);
    if (status == LR_OK)
        status = apply_named(l);
    char *folder = lr_join_path(l->suite->folder, "golden");
    if (!folder)
        status = out_of_memory(l);
    for (uint32_t i = 0; status == LR_OK && i < l->suite->count; i++)
        status = find_golden(l, &l->suite->cases[i], folder);
    if (status == LR_OK)
        status = find_orphans(l, folder);
    free(folder);
    return status;
}

/* ---- Two folders of pictures --------------------------------------------------------------- */

/* A case for every picture of the folder that has none yet. */
static lr_status list_pictures(loader *l, const char *folder)
{
    lr_listing found;
    lr_status status = lr_listing_read(&found, folder, picture_endings, true, l->error);
    for (uint32_t i = 0; status == LR_OK && i < found.count; i++) {
        if (find_case(l, found.paths[i]))
            continue;
        lr_case *item = add_case(l, found.paths[i], strlen(found.paths[i]));
        if (item) {
            item->golden = lr_join_path(l->desc->reference, found.paths[i]);
            item->candidate = lr_join_path(l->desc->candidate, found.paths[i]);
        }
        if (!item || !item->golden || !item->candidate)
            status = out_of_memory(l);
    }
    lr_listing_free(&found);
    return status;
}

static lr_status load_pair(loader *l)
{
    lr_status status = list_pictures(l, l->desc->reference);
    if (status == LR_OK)
        status = list_pictures(l, l->desc->candidate);
    for (uint32_t i = 0; status == LR_OK && i < l->settings->count; i++) {
        const lr_named_settings *named = &l->settings->cases[i];
        lr_case *item = find_case(l, named->name);
        if (item)
            item->settings = named->settings;
        else
            lr_report_add(l->report, named->offset, "no picture is called \"%s\" in %s or %s",
                          named->name, l->desc->reference, l->desc->candidate);
    }
    return status;
}

/* ---- Both ---------------------------------------------------------------------------------- */

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const lr_case *)a)->name, ((const lr_case *)b)->name);
}

static lr_status finish(loader *l, char **report)
{
    lr_suite *suite = l->suite;
    if (l->report->no_memory)
        return out_of_memory(l);
    if (lr_report_failed(l->report)) {
        *report = lr_report_text(l->report);
        return *report ? lr_fail(l->error, LR_ERROR_SCENE, "%.500s: errors in the tests file",
                                 l->report->name)
                       : out_of_memory(l);
    }
    for (uint32_t i = 0; i < suite->count; i++) {
        lr_case *item = &suite->cases[i];
        if (item->settings.mask && !(item->mask = lr_join_path(suite->folder, item->settings.mask)))
            return out_of_memory(l);
    }
    if (suite->count == 0)
        return lr_fail(l->error, LR_ERROR_ARGUMENT,
                       l->desc->reference
                           ? "%.500s: no pictures here; expected some .png, .exr, .pfm, .ppm ..."
                           : "%.500s: no test cases here; expected scenes in scenes/ or in the "
                             "folder itself, or cases in tests.yaml",
                       suite->folder);
    qsort(suite->cases, suite->count, sizeof *suite->cases, compare_names);
    return LR_OK;
}

lr_status lr_suite_load(const lr_suite_desc *desc, lr_suite **suite, char **report, lr_error *error)
{
    *suite = NULL;
    *report = NULL;
    loader l = {.desc = desc, .error = error};
    lr_status status = LR_OK;
    l.report = lr_alloc(1, sizeof *l.report);
    l.suite = lr_alloc(1, sizeof *l.suite);
    if (l.suite)
        l.suite->store = lr_alloc(1, sizeof *l.suite->store);
    if (!l.report || !l.suite || !l.suite->store) {
        status = out_of_memory(&l);
        goto done;
    }
    l.settings = &l.suite->store->settings;
    l.suite->folder = desc->reference ? desc->reference : desc->folder;
    if (!lr_is_folder(l.suite->folder))
        status = lr_fail(error, LR_ERROR_FILE, "%.500s: %s", l.suite->folder,
                         lr_is_file(l.suite->folder) ? "expected a folder of tests, not a file"
                                                     : "there is no such folder");
    if (status == LR_OK)
        status = read_settings(&l);
    if (status == LR_OK)
        status = desc->reference ? load_pair(&l) : load_folder(&l);
    if (status == LR_OK)
        status = finish(&l, report);
    if (status == LR_OK) {
        *suite = l.suite;
        l.suite = NULL;
    }
done:
    lr_names_free(&l.names);
    if (l.report)
        lr_report_free(l.report);
    free(l.report);
    lr_suite_free(l.suite);
    return status;
}

void lr_suite_free(lr_suite *suite)
{
    if (!suite)
        return;
    for (uint32_t i = 0; i < suite->count; i++) {
        lr_case *item = &suite->cases[i];
        free(item->name);
        free(item->scene);
        free(item->golden);
        free(item->candidate);
        free(item->mask);
    }
    for (uint32_t i = 0; i < suite->orphan_count; i++)
        free(suite->orphans[i]);
    free(suite->cases);
    free(suite->orphans);
    if (suite->store) {
        lr_settings_free(&suite->store->settings);
        free(suite->store->path);
        free(suite->store->text);
        free(suite->store->scene_folder);
    }
    free(suite->store);
    free(suite);
}

bool lr_suite_selects(const lr_suite *suite, const lr_case *item, const char *pattern)
{
    for (uint32_t i = 0; i < suite->count; i++)
        if (strcmp(suite->cases[i].name, pattern) == 0)
            return strcmp(item->name, pattern) == 0;
    return strpbrk(pattern, "*?[") ? fnmatch(pattern, item->name, 0) == 0
                                   : strstr(item->name, pattern) != NULL;
}
