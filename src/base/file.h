/* Files: whole-file reads with a size cap, and writes that never leave half a file behind. */
#ifndef LR_BASE_FILE_H
#define LR_BASE_FILE_H

#include "base/status.h"

/* Reads all of path ("-": standard input) into *bytes, NUL-terminated behind *size bytes; the
 * caller frees it. A file of more than `limit` bytes, a directory, an unreadable file:
 * LR_ERROR_FILE with the path and the reason. */
lr_status lr_file_read(const char *path, size_t limit, char **bytes, size_t *size, lr_error *error);

/* The state of the file at path right now. */
lr_file_stamp lr_file_stamp_of(const char *path);

/* Whether nothing can have changed between two states of a path. False after a young one. */
bool lr_file_is_same(const lr_file_stamp *earlier, const lr_file_stamp *later);

/* Writes size bytes to path ("-": standard output). A regular file is written beside its place
 * under a temporary name, flushed to disk and renamed, so the old file stays whole until the new
 * one is; on any failure the temporary file is removed. Devices and pipes are written directly. */
lr_status lr_file_write(const char *path, const void *bytes, size_t size, lr_error *error);

#endif
