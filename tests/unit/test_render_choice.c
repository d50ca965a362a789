/* The table of aliases: every step of a choice is counted. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/choice.h"

#define STEPS (1u << LR_CHOICE_BITS)

/* As choose_emitter() in emitter.glsl. */
static uint32_t choose(const struct gpu_choice *table, uint32_t bits, uint32_t step)
{
    uint32_t shift = LR_CHOICE_BITS - bits, slot = step >> shift;
    return step - (slot << shift) >= table[slot].threshold ? table[slot].second : table[slot].first;
}

static void check(const double *weights, uint32_t count)
{
    uint32_t bits, *steps = calloc(count, sizeof *steps), *seen = calloc(count, sizeof *seen);
    double sum = 0;
    lr_choice_steps(weights, count, steps);
    struct gpu_choice *table = lr_choice_table(steps, count, &bits);
    assert_non_null(table);
    for (uint32_t step = 0; step < STEPS; step++) {
        uint32_t chosen = choose(table, bits, step);
        assert_true(chosen < count);
        seen[chosen]++;
    }
    for (uint32_t i = 0; i < count; i++)
        sum += weights[i];
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(seen[i], steps[i]);
        assert_int_equal(steps[i] > 0, weights[i] > 0);
        double exact = weights[i] / sum * STEPS;
        assert_true(fabs(steps[i] - exact) <= count * fmax(1, exact / STEPS) + 1);
    }
    free(table);
    free(steps);
    free(seen);
}

static void test_every_step(void **state)
{
    (void)state;
    check((const double[]){3}, 1);
    check((const double[]){1, 1}, 2);
    check((const double[]){1, 0, 2}, 3);
    check((const double[]){1e-30, 1e30, 1}, 3);
    check((const double[]){0, 0, 0, 0, 1}, 5);
    static double many[LR_CHOICES_MAX];
    for (uint32_t count = 6; count <= LR_CHOICES_MAX; count = count * 9 + 1) {
        for (uint32_t i = 0; i < count; i++)
            many[i] = (double)(i * 2654435761u % 1000) * (i % 97 ? 1 : 1e6);
        check(many, count);
    }
    for (uint32_t i = 0; i < LR_CHOICES_MAX; i++)
        many[i] = i % 2 ? 1e-9 : 1;
    check(many, LR_CHOICES_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
