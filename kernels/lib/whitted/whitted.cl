// Whitted's ray tree (Whitted 1980) walked with an explicit stack, in two ways: a batch of pixels together,
// or one ray after another. What a pixel receives is added in an order that depends on nothing but the
// work-item's pixels.
#pragma once
#include "lib/whitted/whitted_batch.cl"
#include "lib/whitted/whitted_single.cl"
