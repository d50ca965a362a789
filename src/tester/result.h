/* What came of the cases: the data of all reports. */
#ifndef LR_TESTER_RESULT_H
#define LR_TESTER_RESULT_H

#include "tester/suite.h"

typedef enum lr_outcome {
    LR_OUTCOME_NOT_RUN, /* after --fail-fast or an interrupt */
    LR_OUTCOME_PASSED,
    LR_OUTCOME_UPDATED, /* it differed, and the golden was replaced */
    LR_OUTCOME_ADDED,   /* it had no golden, and now has one */
    LR_OUTCOME_DIFFERS,
    LR_OUTCOME_MISSING, /* there is no golden */
    LR_OUTCOME_BROKEN,  /* there is no picture, or something could not be read or written */
    LR_OUTCOME_COUNT
} lr_outcome;

/* "differs" for LR_OUTCOME_DIFFERS, as in the reports. */
const char *lr_outcome_name(lr_outcome outcome);
bool lr_outcome_failed(lr_outcome outcome);

/* Where a picture came from, as it says in its own file. Empty: it does not say. */
typedef struct lr_stamp {
    char software[64]; /* "lavaray 0.1.0" */
    char scene[80];    /* SHA-256 of the scene's text */
    char settings[512];
    char pixels[80]; /* SHA-256 of the linear pixels; see lr_picture_hash */
} lr_stamp;

/* Texts are NULL when there is nothing to say. */
typedef struct lr_case_result {
    const lr_case *item;
    lr_outcome outcome;
    double seconds;
    char *message;    /* one line: why it did not pass */
    char *cause;      /* sentences: what differs */
    char *staleness;  /* one sentence: whether the scene or the renderer changed */
    char *output;     /* the last lines that the command wrote, safe to print */
    char *command;    /* that made the picture, for a shell */
    char *candidate;  /* paths of the pictures that were kept */
    char *difference; /* the heat map */
    char *device, *driver;
    bool readable; /* the candidate is a picture: it may become the golden */
    bool crashed;  /* the comparison did: nothing opens these pictures again */
    bool compared;
    lr_compare_result compare; /* without its map */
    lr_stamp golden_stamp, candidate_stamp;
} lr_case_result;

void lr_case_result_free(lr_case_result *result);

#endif
