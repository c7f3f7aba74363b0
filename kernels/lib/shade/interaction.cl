// Surfaces that rays have met, in lanes (plain/shade/interaction.cl), and what that calls.
#pragma once
#include "lib/core/motion.cl"
#include "lib/path/fields.cl"
#include "lib/path/segment.cl"
#include "plain/shade/interaction.cl"
