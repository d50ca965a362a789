#include "cli/cli.h"
#include "cli/progress.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const command *const commands[] = {&command_render,   &command_merge,   &command_view,
                                          &command_explain,  &command_devices, &command_doctor,
                                          &command_validate, &command_info,    &command_convert,
                                          &command_schema,   &command_compare, &command_test};
enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static bool is_terminal(int fd)
{
    const char *term = getenv("TERM");
    return isatty(fd) && term && *term && strcmp(term, "dumb") != 0;
}

bool terminal_present(void)
{
    return is_terminal(STDERR_FILENO);
}

bool stream_has_color(int fd)
{
    const char *no_color = getenv("NO_COLOR");
    return is_terminal(fd) && !(no_color && *no_color);
}

bool terminal_has_color(void)
{
    return stream_has_color(STDERR_FILENO);
}

static void print_message(const char *color, const char *format, va_list arguments)
{
    fflush(stdout);
    if (terminal_has_color()) {
        fprintf(stderr, "\033[%smlavaray:\033[0m ", color);
    } else {
        fputs("lavaray: ", stderr);
    }
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
}

void print_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_message("1;31", format, arguments);
    va_end(arguments);
}

int wrong_usage(const command *self, const char *text)
{
    print_error("%s; see lavaray %s --help", text, self->name);
    return EXIT_USAGE;
}

void print_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_message("1;33", format, arguments);
    va_end(arguments);
}

int report_failure(const lr_error *error)
{
    print_error("%s", error->message[0] ? error->message : "failed without saying why");
    switch (error->status) {
    case LR_ERROR_ARGUMENT:
        return EXIT_USAGE;
    case LR_ERROR_SCENE:
        return EXIT_SCENE;
    case LR_ERROR_FILE:
        return EXIT_FILE;
    case LR_ERROR_INTERRUPTED:
        return EXIT_INTERRUPTED;
    case LR_OK:
    case LR_ERROR_DEVICE:
    case LR_ERROR_MEMORY:
        break;
    }
    return EXIT_DEVICE;
}

bool validation_wanted(void)
{
    const char *value = getenv("LAVARAY_VALIDATION");
    return value && *value && strcmp(value, "0") != 0;
}

int check_validation(const lr_device *device, int code)
{
    char text[1024] = "";
    uint32_t count = validation_wanted() && device
                         ? lr_device_validation_messages(device, text, sizeof text)
                         : 0;
    if (count == 0) {
        return code;
    }
    print_error("%u validation messages, the first: %s", (unsigned)count, text);
    return EXIT_DEVICE;
}

double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

version_text format_version(uint32_t version)
{
    version_text result;
    snprintf(result.text, sizeof result.text, "%u.%u.%u", (unsigned)(version >> 22 & 0x7f),
             (unsigned)(version >> 12 & 0x3ff), (unsigned)(version & 0xfff));
    return result;
}

static void print_overview(FILE *file)
{
    fputs("lavaray " LR_VERSION ": renders a scene to the same bytes on every Vulkan device\n\n"
          "Usage: lavaray COMMAND [ARGUMENTS]\n\nCommands:\n",
          file);
    for (int i = 0; i < COMMAND_COUNT; i++) {
        fprintf(file, "  %-10s%s\n", commands[i]->name, commands[i]->summary);
    }
    fputs("  help      print this text, or with a command's name its help\n"
          "\nlavaray COMMAND --help tells more; lavaray --version prints the version.\n"
          "\nA first picture:\n"
          "  lavaray render scenes/showcase.yaml -o showcase.png\n"
          "\nExit codes:\n"
          "  0    done\n"
          "  1    pictures differ from what was expected\n"
          "  2    the command line is wrong\n"
          "  3    the scene is invalid\n"
          "  4    no usable device, the device was lost, or memory ran out\n"
          "  5    a file could not be read or written\n"
          "  130  interrupted\n"
          "\nEnvironment:\n"
          "  NO_COLOR            no colours, whatever the terminal can do\n"
          "  LAVARAY_VALIDATION  1: use the Vulkan validation layer; any message is exit code 4\n"
          "  VK_DRIVER_FILES, VK_ICD_FILENAMES\n"
          "                      which Vulkan drivers there are (read by the Vulkan loader)\n",
          file);
}

static const command *find_command(const char *name)
{
    const char *best = NULL;
    unsigned distance = UINT_MAX;
    for (int i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(name, commands[i]->name) == 0) {
            return commands[i];
        }
        best = nearest_name(name, commands[i]->name, best, &distance);
    }
    best = best ? best : nearest_name(name, "help", NULL, &distance);
    const char *kind = name[0] == '-' ? "flag" : "command";
    if (best && name[0] != '-') {
        print_error("unknown command '%s', did you mean '%s'? See lavaray --help", name, best);
    } else {
        print_error("unknown %s '%s'; see lavaray --help", kind, name);
    }
    return NULL;
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        print_overview(stderr);
        return EXIT_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--version") == 0 || strcmp(name, "-V") == 0) {
        puts("lavaray " LR_VERSION);
        return EXIT_FINE;
    }
    bool is_help =
        strcmp(name, "help") == 0 || strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0;
    if (is_help && argc == 2) {
        print_overview(stdout);
        return EXIT_FINE;
    }
    const command *found = find_command(is_help ? argv[2] : name);
    if (!found) {
        return EXIT_USAGE;
    }
    if (is_help) {
        options_print_help(found);
        return EXIT_FINE;
    }
    return found->run(found, argc - 2, argv + 2);
}

/* A closed standard stream would lend its number to the next file that is opened, which would then
 * receive what is printed. An occupied number that refuses the transfer makes prints fail. */
static void occupy_standard_streams(void)
{
    for (int fd = 0; fd <= 2; fd++) {
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF) {
            int opened = open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
            if (opened != fd && opened != -1) {
                close(opened);
            }
        }
    }
}

int main(int argc, char **argv)
{
    occupy_standard_streams();
    signal(SIGPIPE, SIG_IGN);
    if (!isatty(STDOUT_FILENO)) {
        /* Large enough that nothing is written before the end, where the reason of a failure is
         * known. */
        static char buffer[1 << 18];
        setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    }
    int code = run(argc, argv);
    errno = 0;
    if (fflush(stdout) != 0 || ferror(stdout)) {
        print_error("cannot write standard output: %s", errno ? strerror(errno) : "write error");
        code = code == EXIT_FINE ? EXIT_FILE : code;
    }
    if (ferror(stderr) && code == EXIT_FINE) {
        code = EXIT_FILE;
    }
    return code;
}
