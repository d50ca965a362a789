/* The start-up check of the arithmetic that the exact promise rests on (docs/exact.md). */
#ifndef LR_GPU_SELF_TEST_H
#define LR_GPU_SELF_TEST_H

#include "gpu/device.h"

/* Runs shaders/self_test.comp; *exact tells whether the device computed what IEEE 754 demands. */
lr_status lr_self_test(lr_device *device, bool *exact, lr_error *error);

#endif
