/* Every part is worked on once, whatever their number and the threads'. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <cmocka.h>

#include "base/parallel.h"

enum { PARTS_MAX = 1000 };

static void count(void *context, uint32_t part)
{
    _Atomic int *counts = context;
    atomic_fetch_add(&counts[part], 1);
}

static void test_parts(void **state)
{
    (void)state;
    static const uint32_t parts[] = {0, 1, 2, 17, PARTS_MAX - 1};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        for (uint32_t threads = 0; threads <= 20; threads += 5) {
            _Atomic int counts[PARTS_MAX] = {0};
            lr_run_parallel_on(threads, parts[i], count, counts);
            lr_run_parallel(parts[i], count, counts);
            for (uint32_t k = 0; k < PARTS_MAX; k++)
                assert_int_equal(counts[k], k < parts[i] ? 2 : 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
