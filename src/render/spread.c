#include "render/spread.h"

#include "render/film.h"

/* West, "Updating Mean and Variance Estimates", CACM 22-9, 1979. */
void lr_spread_add(lr_spread *spread, const uint32_t *film)
{
    double samples = film[LR_FILM_SAMPLES];
    spread->samples += film[LR_FILM_SAMPLES];
    spread->ranges++;
    for (uint32_t channel = 0; channel < 3; channel++) {
        double value = (double)lr_film_sum(film, channel) / (double)(1ull << LR_FILM_STEP_BITS);
        if (film[LR_FILM_FLAGS] & 1u << channel)
            value = LR_FILM_MAX;
        double difference = value / samples - spread->mean[channel];
        spread->mean[channel] += difference * samples / spread->samples;
        spread->squares[channel] +=
            samples * difference * (value / samples - spread->mean[channel]);
    }
}

/* Ranges of n_i of the N samples have the variance s^2 / n_i, so the sum of n_i (their mean -
 * mean)^2 is (ranges - 1) s^2, and the mean has s^2 / N. */
void lr_spread_variance(const lr_spread *spread, float variance[3])
{
    for (uint32_t channel = 0; channel < 3; channel++)
        variance[channel] =
            spread->ranges < 2
                ? 0
                : (float)(spread->squares[channel] / spread->samples / (spread->ranges - 1));
}
