/* Files in folders, and paths. */
#ifndef LR_TESTER_LISTING_H
#define LR_TESTER_LISTING_H

#include "base/status.h"

typedef struct lr_listing {
    char **paths; /* relative to the folder, sorted by bytes */
    uint32_t count, capacity;
} lr_listing;

/* Adds the regular files of the folder, and with `deep` of the folders below it, whose names end in
 * one of `endings` (NULL behind the last, without the dot, compared without regard to case). Names
 * that begin with a dot are left out; links are followed to files, not to folders. A folder that
 * cannot be read is LR_ERROR_FILE. */
lr_status lr_listing_read(lr_listing *listing, const char *folder, const char *const *endings,
                          bool deep, lr_error *error);
void lr_listing_free(lr_listing *listing);

/* "folder/name"; just the name when it is absolute or the folder is ".", and the folder when the
 * name is empty. NULL when memory is out. */
char *lr_join_path(const char *folder, const char *name);

/* The bytes of path in front of its ending, "a/b" of "a/b.png". */
size_t lr_stem_length(const char *path);

bool lr_is_folder(const char *path);
bool lr_is_file(const char *path);

/* Creates the folders above path that are missing. */
lr_status lr_make_folders(const char *path, lr_error *error);

/* Removes a folder and all that is in it, as far as that is possible. */
void lr_remove_tree(const char *folder);

#endif
