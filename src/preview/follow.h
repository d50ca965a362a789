/* Follows files while others edit them: tells that some have changed, once for each burst of edits.
 * Linux's inotify wakes it; what counts is that a file's lr_file_stamp is another one. Editors that
 * write beside the file and rename, files that come and go, symbolic links and folders that are
 * replaced are all followed. Where inotify does not reach (network file systems, no watches left)
 * the files are looked at twice a second. */
#ifndef LR_PREVIEW_FOLLOW_H
#define LR_PREVIEW_FOLLOW_H

#include "lavaray.h"

typedef struct lr_follow lr_follow;

/* NULL when memory is out. */
lr_follow *lr_follow_create(void);
void lr_follow_destroy(lr_follow *follow);

/* Follows these files and no others. They have changed when they are no longer as the list says, so
 * nothing is missed that happens between reading them and this call. False when memory is out; the
 * files are then those of before. */
bool lr_follow_files(lr_follow *follow, const lr_file_list *files);

/* What to wait for with poll(): POLLIN on the descriptor (-1: none), and the time in seconds until
 * the next lr_follow_changed is due (negative: none). `now` is of any clock that goes evenly. */
int lr_follow_descriptor(const lr_follow *follow);
double lr_follow_wait(const lr_follow *follow, double now);

/* Whether files have changed, to be asked when lr_follow_wait's time is over or there is something
 * to read. An edit is told when there was none for 30 ms, at the latest after 200 ms. */
bool lr_follow_changed(lr_follow *follow, double now);

/* What lies at the path now is no news: the caller has written it. */
void lr_follow_forget_own_write(lr_follow *follow, const char *path);

#endif
