/* How an explained pixel is told. */
#ifndef LR_CLI_EXPLAIN_PRINT_H
#define LR_CLI_EXPLAIN_PRINT_H

#include "cli/cli.h"

typedef struct explained_pixel {
    const char *path, *camera; /* camera: NULL if none was asked for */
    const lr_scene *scene;
    const lr_explanation *explanation;
} explained_pixel;

/* Prints the tree for people, 100 columns wide where it is not too deep. */
void print_explanation(const explained_pixel *pixel);

/* Prints it as JSON (docs/explain.md). Returns an exit_code. */
int print_explanation_json(const explained_pixel *pixel);

/* A number of steps as light. */
double explained_light(uint64_t steps);

#endif
