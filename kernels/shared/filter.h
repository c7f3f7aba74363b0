// The table by which camera samples are placed: of one axis, by the cumulative density of the filter's
// absolute value.
#ifndef SUNDOG_SHARED_FILTER_H
#define SUNDOG_SHARED_FILTER_H

// Floats: the share of the lobes below zero; the distances from the centre that FILTER_STEPS equal shares of
// the part above zero reach to, with 0 before them; the same of the lobes below zero.
#define FILTER_STEPS 256
#define FILTER_ABOVE 1
#define FILTER_BELOW (FILTER_ABOVE + FILTER_STEPS + 1)
#define FILTER_TABLE (FILTER_BELOW + FILTER_STEPS + 1)

#endif
