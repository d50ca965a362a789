/* Compiles GLSL for the SPIR-V tests with the installed tools, in a temporary folder. */
#ifndef LR_TESTS_SPIRV_COMPILE_H
#define LR_TESTS_SPIRV_COMPILE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "base/file.h"
#include "gpu/spirv.h"

static char spirv_folder[64];

static inline const char *spirv_path(const char *name)
{
    static char path[4][128];
    static unsigned next;
    char *result = path[next++ % 4];
    snprintf(result, sizeof path[0], "%s/%s", spirv_folder, name);
    return result;
}

static inline int spirv_setup(void **state)
{
    (void)state;
    strcpy(spirv_folder, "/tmp/lavaray-spirv-XXXXXX");
    return mkdtemp(spirv_folder) ? 0 : -1;
}

static inline int spirv_teardown(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", spirv_folder);
    return system(command);
}

static inline bool spirv_has_tool(const char *name)
{
    char command[128];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", name);
    if (system(command) == 0)
        return true;
    print_message("%s is not installed\n", name);
    return false;
}

static inline lr_spirv spirv_load(const char *path)
{
    char *bytes;
    size_t size;
    lr_error error = {0};
    if (lr_file_read(path, 1 << 24, &bytes, &size, &error) != LR_OK)
        fail_msg("%s", error.message);
    assert_int_equal(size % 4, 0);
    lr_spirv module = {malloc(size), size / 4};
    memcpy(module.words, bytes, size);
    free(bytes);
    return module;
}

/* Skips the test when there is no compiler. */
static inline lr_spirv spirv_compile(const char *source)
{
    static int has_compiler = -1;
    if (has_compiler < 0)
        has_compiler = spirv_has_tool("glslangValidator");
    if (!has_compiler)
        skip();
    char command[512];
    lr_error error = {0};
    const char *in = spirv_path("in.comp"), *out = spirv_path("out.spv");
    assert_int_equal(lr_file_write(in, source, strlen(source), &error), LR_OK);
    snprintf(command, sizeof command,
             "glslangValidator -V --quiet --target-env vulkan1.1 -o %s %s >%s/log 2>&1 || "
             "{ cat %s/log >&2; exit 1; }",
             out, in, spirv_folder, spirv_folder);
    if (system(command) != 0)
        fail_msg("does not compile:\n%s", source);
    return spirv_load(out);
}

/* Whether spirv-val accepts the module; true when it is not installed. */
static inline bool spirv_is_valid(const uint32_t *words, size_t count)
{
    char command[256];
    lr_error error = {0};
    const char *path = spirv_path("validate.spv");
    if (!spirv_has_tool("spirv-val"))
        return true;
    assert_int_equal(lr_file_write(path, words, count * 4, &error), LR_OK);
    snprintf(command, sizeof command, "spirv-val --target-env vulkan1.2 %s", path);
    return system(command) == 0;
}

/* The number of instructions that begin with these words. */
static inline unsigned spirv_count(const lr_spirv *module, const uint32_t *words, size_t count)
{
    unsigned found = 0;
    for (size_t at = 5; at < module->count; at += module->words[at] >> 16)
        if (module->count - at >= count && (module->words[at] & 0xffff) == words[0] &&
            memcmp(module->words + at + 1, words + 1, (count - 1) * sizeof *words) == 0)
            found++;
    return found;
}

/* The kinds of resources that the snippets of the tests work on; %s are extensions and globals,
 * and the body of shade. */
#define SPIRV_TEMPLATE                                                                             \
    "#version 450\n"                                                                               \
    "%s\n"                                                                                         \
    "layout(local_size_x = 64) in;\n"                                                              \
    "layout(std430, binding = 0) buffer F { float f[]; };\n"                                       \
    "layout(std430, binding = 1) buffer U { uint u[]; };\n"                                        \
    "layout(std430, binding = 2) buffer S { int s[]; };\n"                                         \
    "layout(binding = 3) uniform samplerBuffer texels;\n"                                          \
    "layout(binding = 4) uniform sampler2D picture;\n"                                             \
    "layout(binding = 5, r32f) uniform image2D pixels;\n"                                          \
    "layout(constant_id = 0) const uint SPEC = 3;\n"                                               \
    "layout(constant_id = 1) const bool SPEC_BOOL = true;\n"                                       \
    "void shade(uint i, vec3 a, vec3 b) { %s }\n"                                                  \
    "void main() { shade(gl_GlobalInvocationID.x, vec3(f[0], f[1], f[2]), vec3(f[3])); }\n"

#endif
