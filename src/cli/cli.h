/* What the commands share: exit codes, their table, and messages to the user. Only this folder
 * prints or chooses exit codes. */
#ifndef LR_CLI_CLI_H
#define LR_CLI_CLI_H

#include "cli/exit_codes.h"
#include "cli/options.h"
#include "lavaray.h"

typedef struct command {
    const char *name;
    const char *operands; /* as the usage line shows them, such as "SCENE" */
    const char *summary;  /* one line for the list of commands */
    const char *details;  /* paragraphs for the command's own help */
    const char *examples;
    const option *options;
    unsigned option_count;
    int min_operands, max_operands;
    int (*run)(const struct command *self, int argc, char **argv); /* returns an exit_code */
} command;

extern const command command_render, command_devices, command_doctor, command_validate,
    command_schema, command_compare, command_test, command_convert, command_info, command_view,
    command_explain, command_merge;

/* One line on stderr, with "lavaray: " in front. */
void print_error(const char *format, ...) __attribute__((format(printf, 1, 2)));
void print_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Prints what is wrong with the command line and where help is; returns EXIT_USAGE. */
int wrong_usage(const command *self, const char *text);

/* Whether stderr is a terminal that escape sequences can be sent to. */
bool terminal_present(void);
/* The same, and NO_COLOR does not forbid colours. */
bool terminal_has_color(void);
/* The same of another file descriptor. */
bool stream_has_color(int fd);

/* Prints what failed and returns the exit code that belongs to it. */
int report_failure(const lr_error *error);

/* Whether LAVARAY_VALIDATION asks for the validation layer. */
bool validation_wanted(void);
/* With validation on, prints the first message that the device has got, if any, and returns
 * EXIT_DEVICE; otherwise returns code. */
int check_validation(const lr_device *device, int code);

/* Seconds of a clock that only goes forward. */
double seconds_now(void);

/* "1.3.230" from a Vulkan version number. */
typedef struct version_text {
    char text[40];
} version_text;
version_text format_version(uint32_t version);

#endif
