/* Gathers samples into the sums of a picture, in an order that can be left and taken up again at
 * any time: the counts of samples in the film are all the state there is. */
#ifndef LR_RENDER_GATHER_H
#define LR_RENDER_GATHER_H

#include "render/job.h"

/* Whether a render goes over the picture more than once, and so has to gather. */
bool lr_needs_sums(const lr_render_options *options);

/* Brings all pixels of the sums to the samples that they are to have. With a checkpoint, first
 * takes over what it holds; a failure on the way leaves one behind. With a time limit, sums->count
 * becomes the number of samples reached. The progress is told to job->options. */
lr_status lr_gather(lr_job *job, lr_sums *sums, lr_error *error);

#endif
