/* Any bytes must read as settings of tests or to a report, without a crash, a leak or much time. */
#include "tester/settings.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static lr_report report;
    lr_settings settings = {0};
    report = (lr_report){.language = &lr_settings_language,
                         .name = "fuzz.yaml",
                         .text = (const char *)data,
                         .length = size};
    lr_settings_read(&settings, &report);
    for (uint32_t i = 0; i < settings.count; i++)
        if (settings.cases[i].settings.run && settings.cases[i].settings.run_count == 0)
            abort();
    if (lr_report_failed(&report) && !report.no_memory)
        free(lr_report_text(&report));
    lr_report_free(&report);
    lr_settings_free(&settings);
    return 0;
}
