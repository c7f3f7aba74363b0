// Integer sample values, equal on host and device: an Owen-scrambled Sobol sequence of four dimensions,
// shuffled anew for every further four (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020). A
// value depends only on pixel, sample and dimension.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// Distributions of samples in pixels, with their names in scene files. AUTO is a Hammersley set for a fixed
// number of samples, which STRATIFIED, REGULAR and BLUE_NOISE need too; the others allow more samples to be
// added. In dimensions other than the pixel's, all except INDEPENDENT and BLUE_NOISE use the Sobol sequence
// of the pixel.
#define SAMPLERS(SAMPLER)                   \
  SAMPLER(SAMPLER_AUTO, auto)               \
  SAMPLER(SAMPLER_SOBOL, sobol)             \
  SAMPLER(SAMPLER_STRATIFIED, stratified)   \
  SAMPLER(SAMPLER_REGULAR, regular)         \
  SAMPLER(SAMPLER_INDEPENDENT, independent) \
  SAMPLER(SAMPLER_BLUE_NOISE, blue_noise)
#define SAMPLER_AUTO 0
#define SAMPLER_SOBOL 1
#define SAMPLER_STRATIFIED 2
#define SAMPLER_REGULAR 3
#define SAMPLER_INDEPENDENT 4
#define SAMPLER_BLUE_NOISE 5

// Dimensions of a pixel's sample. Each four from a multiple of four belong together: their points are
// stratified in all four, best in the first two, so pairs of values start at even numbers. The dimensions of
// the surface hit by a ray of `depth` (1: from the camera) begin at DIMENSION_BOUNCE + DIMENSIONS_A_BOUNCE *
// (depth - 1); individually sampled lights take a copy each, the light of index i from DIMENSIONS_OF_LIGHT(i)
// later.
#define DIMENSION_PIXEL 0u  // two: position in the pixel
#define DIMENSION_LENS 2u   // two: position on the lens
#define DIMENSION_TIME 4u   // one; 5, 6 and 7 are free
#define DIMENSION_BOUNCE 8u
#define DIMENSIONS_A_BOUNCE 8u
#define DIMENSIONS_OF_LIGHT(light) ((light) << 12)
#define BOUNCE_LIGHT_POINT 0u   // two: position on a light
#define BOUNCE_LIGHT_CHOICE 2u  // one: which light
#define BOUNCE_DIRECTION 4u     // two: scattered direction
#define BOUNCE_LOBE 6u          // one: reflection or transmission
#define BOUNCE_ROULETTE 7u      // one: Russian roulette
// Eight dimensions of a scattering medium before that surface; each interface that the ray has crossed unseen
// uses another set.
#define DIMENSION_STRETCH 0x10000u
#define DIMENSIONS_A_CROSSING 0x1000000u

// PCG's output permutation of a counter (O'Neill 2014; Jarzynski and Olano 2020).
static inline u32 hash_u32(u32 x) {
  const u32 state = x * 747796405u + 2891336453u;
  const u32 word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

static inline u32 hash_pixel(u32 x, u32 y, u32 dimension) {
  return hash_u32(x + hash_u32(y + hash_u32(dimension)));
}

static inline u32 reversed_bits(u32 r) {
  r = (r << 16) | (r >> 16);
  r = ((r & 0x00ff00ffu) << 8) | ((r & 0xff00ff00u) >> 8);
  r = ((r & 0x0f0f0f0fu) << 4) | ((r & 0xf0f0f0f0u) >> 4);
  r = ((r & 0x33333333u) << 2) | ((r & 0xccccccccu) >> 2);
  return ((r & 0x55555555u) << 1) | ((r & 0xaaaaaaaau) >> 1);
}

// A permutation in which each bit depends only on lower bits (Laine and Karras 2011), so on reversed bits it
// is an Owen scrambling. Vegdahl's constants: any bit flips half of the higher bits.
static inline u32 owen_hash(u32 x, u32 seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ x * 0x53a22864u;
}

// The sequence repeats after this many samples.
#define SOBOL_SAMPLES 65536u

// Direction numbers of two dimensions (low and high 16 bits), reversed: a column per bit of the reversed
// index, in groups of four: COLUMNS(first bit, columns of this bit and the next three) is their sum (mod 2)
// for an index. Dimensions 0 and 1: van der Corput, and x + 1.
#define SOBOL_PAIR_01(COLUMNS)                                      \
  (COLUMNS(0, 0xffff8000u, 0x55554000u, 0x33332000u, 0x11111000u) ^ \
   COLUMNS(4, 0x0f0f0800u, 0x05050400u, 0x03030200u, 0x01010100u) ^ \
   COLUMNS(8, 0x00ff0080u, 0x00550040u, 0x00330020u, 0x00110010u) ^ \
   COLUMNS(12, 0x000f0008u, 0x00050004u, 0x00030002u, 0x00010001u))

// Dimensions 2 and 3: x^2 + x + 1 with 1, 3, and x^3 + x + 1 with 1, 1, 3, which fill each eighth of a square
// with the first eight samples.
#define SOBOL_PAIR_23(COLUMNS)                                      \
  (COLUMNS(0, 0xb082aa09u, 0x60417706u, 0x203f3903u, 0x10151601u) ^ \
   COLUMNS(4, 0x0ff409aau, 0x05530677u, 0x02f60339u, 0x01920116u) ^ \
   COLUMNS(8, 0x008900a3u, 0x00470071u, 0x003d003au, 0x00140017u) ^ \
   COLUMNS(12, 0x000b0009u, 0x00060006u, 0x00020003u, 0x00010001u))

// For the index `order`, which may be a vector.
#define SOBOL_COLUMN(bit, column) ((column) & (0u - ((order >> (bit)) & 1u)))
#define SOBOL_COLUMNS(bit, a, b, c, d)                                              \
  (SOBOL_COLUMN(bit, a) ^ SOBOL_COLUMN((bit) + 1, b) ^ SOBOL_COLUMN((bit) + 2, c) ^ \
   SOBOL_COLUMN((bit) + 3, d))
static inline u32 sobol_pair_01(u32 order) { return SOBOL_PAIR_01(SOBOL_COLUMNS); }
static inline u32 sobol_pair_23(u32 order) { return SOBOL_PAIR_23(SOBOL_COLUMNS); }

// The reversed index (16 bits) of a sample in a sequence shuffled by `seed`: aligned runs of 2^k samples
// remain such runs.
static inline u32 sobol_order(u32 sample, u32 seed) {
  return owen_hash(reversed_bits(sample) >> 16, seed) & 0xffffu;
}

// Owen scrambling of the 16 reversed bits of dimension `component`; returns 2^32 times a number in [0, 1).
static inline u32 sobol_scrambled(u32 reversed, u32 seed, u32 component) {
  return reversed_bits(owen_hash(reversed & 0xffffu, hash_u32(seed + 0x9e3779b9u * (component + 1u))));
}

// The bits of a pixel's sample in one dimension, as 2^32 times a number in [0, 1).
static inline u32 sobol_bits(u32 x, u32 y, u32 sample, u32 dimension) {
  const u32 seed = hash_pixel(x, y, dimension >> 2), order = sobol_order(sample, seed);
  const u32 pair = dimension & 2u ? sobol_pair_23(order) : sobol_pair_01(order);
  return sobol_scrambled(dimension & 1u ? pair >> 16 : pair, seed, dimension & 3u);
}

// Screen-space blue noise: the pixels in Z-order take runs of 2^room samples of one sequence, the first two
// Sobol dimensions, shuffled anew for every two dimensions (Ahmed and Wonka 2020, "Screen-Space Blue-Noise
// Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels"; pbrt's ZSobolSampler, here
// shuffled as above). The samples of a block of pixels are then stratified together, so that errors of
// neighbours cancel.

// Interleaves the bits of x and y. Both may be vectors.
#define SPREAD_STEP(v, shift, mask) (((v) | ((v) << (shift))) & (mask))
#define SPREAD_BITS(v)                                                                                      \
  SPREAD_STEP(                                                                                              \
      SPREAD_STEP(SPREAD_STEP(SPREAD_STEP((v) & 0xffffu, 8, 0x00ff00ffu), 4, 0x0f0f0f0fu), 2, 0x33333333u), \
      1, 0x55555555u)
#define Z_ORDER(x, y) (SPREAD_BITS(x) | SPREAD_BITS(y) << 1)

// The reversed index in the sequence; pictures too large for its 2^32 samples drop the highest bits of the
// pixels' order.
static inline u32 blue_noise_order(u32 x, u32 y, u32 sample, u32 room, u32 dimension) {
  return owen_hash(reversed_bits(Z_ORDER(x, y) << room | sample), hash_u32(dimension >> 1));
}

// Sobol's second dimension of a reversed index: Pascal's triangle modulo 2.
static inline u32 sobol_second(u32 order) {
  order ^= order << 16;
  order ^= (order & 0x00ff00ffu) << 8;
  order ^= (order & 0x0f0f0f0fu) << 4;
  order ^= (order & 0x33333333u) << 2;
  return order ^ (order & 0x55555555u) << 1;
}

// sobol_bits() for blue noise.
static inline u32 blue_noise_bits(u32 x, u32 y, u32 sample, u32 room, u32 dimension) {
  const u32 order = blue_noise_order(x, y, sample, room, dimension);
  const u32 place = dimension & 1u ? sobol_second(order) : order;
  return reversed_bits(owen_hash(reversed_bits(place), hash_u32(dimension + 0x9e3779b9u)));
}

SUNDOG_SHARED_END
