// What paths through reliefs are bounded by.
#pragma once
#define PARALLAX_SLANT 0.05f  // minimum sine of rays along the surface
#define PARALLAX_STEPS 128    // maximum
