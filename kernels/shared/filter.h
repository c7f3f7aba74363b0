// The table that places camera samples along one axis: the inverse of the cumulative density of the filter's
// absolute value.
#pragma once

// Floats: the share of the negative lobes; 0 and the distances from the centre at FILTER_STEPS equal
// quantiles of the positive part; likewise for the negative lobes.
#define FILTER_STEPS 256
#define FILTER_ABOVE 1
#define FILTER_BELOW (FILTER_ABOVE + FILTER_STEPS + 1)
#define FILTER_TABLE (FILTER_BELOW + FILTER_STEPS + 1)
