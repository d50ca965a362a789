/* A small set of built-in scenes whose hashes tell whether a device keeps the exact promise. */
#ifndef LR_CLI_SELF_TEST_H
#define LR_CLI_SELF_TEST_H

#include "lavaray.h"

/* Renders the scenes on the device with this index, prints their hashes, whether they are the
 * expected ones, and a row for the table in docs/exact.md. Returns an exit_code. */
int run_self_test(uint32_t device_index);

#endif
