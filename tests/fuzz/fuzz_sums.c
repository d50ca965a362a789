/* Any bytes must read as the part of a render or be refused with a message, without a crash, a leak
 * or much time. */
#include "render/sums.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    lr_sums sums;
    lr_error error = {0};
    if (lr_sums_decode(data, size, "file", &sums, &error) != LR_OK) {
        if (!error.message[0])
            abort();
        return 0;
    }
    if (sums.count == 0 || sums.first + sums.count > sums.samples ||
        !(lr_sums_done(&sums) >= 0 && lr_sums_done(&sums) <= 1))
        abort();
    lr_sums_free(&sums);
    return 0;
}
