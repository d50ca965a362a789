/* JSON to files. */
#ifndef LR_CLI_JSON_H
#define LR_CLI_JSON_H

#include <jansson.h>

/* Writes the value, indented, to path, "-" for standard output, and gives it up; NULL is one that
 * could not be made. Returns an exit_code, having printed what failed. */
int write_json(json_t *json, const char *path);

#endif
