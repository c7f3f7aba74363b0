// Sample values as integers, computed by host and kernels alike: an Owen-scrambled Sobol sequence of four
// dimensions, shuffled for every four dimensions more (Burley, Practical Hash-based Owen Scrambling, JCGT
// 9(4), 2020). A value depends on pixel, sample and dimension alone.
#ifndef SUNDOG_SHARED_SAMPLER_H
#define SUNDOG_SHARED_SAMPLER_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// How samples lie in their pixels: their names in scene files. AUTO is a set of Hammersley's for a fixed
// number of samples, which STRATIFIED, REGULAR and BLUE_NOISE need to know too; to the samples of the others
// more can be added. In dimensions other than the pixel's all but INDEPENDENT and BLUE_NOISE use the Sobol
// sequence of the pixel.
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

// The dimensions of a pixel's sample. Four from a multiple of four on belong together: their points are
// spread evenly in all four, best in the first two, so a pair of values has an even number. What a path needs
// at a surface begins at dimension_of_bounce(); `lights` that are sampled one by one take a copy each.
#define DIMENSION_PIXEL 0u  // two: the place in the pixel
#define DIMENSION_LENS 2u   // two: the place on the lens
#define DIMENSION_TIME 4u   // one; 5, 6 and 7 are free
#define DIMENSION_BOUNCE 8u
#define DIMENSIONS_A_BOUNCE 8u
#define BOUNCE_LIGHT_POINT 0u   // two: the place on a light
#define BOUNCE_LIGHT_CHOICE 2u  // one: which light
#define BOUNCE_DIRECTION 4u     // two: the direction that the surface scatters to
#define BOUNCE_LOBE 6u          // one: reflection or transmission
#define BOUNCE_ROULETTE 7u      // one: whether the path ends
// What a medium that scatters needs on the way to that surface, eight from here on; each interface that the
// ray has crossed unseen takes its own.
#define DIMENSION_STRETCH 0x10000u
#define DIMENSIONS_A_CROSSING 0x1000000u

// The first dimension of what is sampled at the surface that a ray of `depth` (1: from the camera) meets, for
// the light of index `light` (0 where it is no light's).
static inline u32 dimension_of_bounce(u32 depth, u32 light) {
  return DIMENSION_BOUNCE + DIMENSIONS_A_BOUNCE * (depth - 1u) + (light << 12);
}

// PCG's output permutation on a counter (O'Neill 2014; Jarzynski and Olano 2020).
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

// A permutation in which each bit depends on those below it alone (Laine and Karras 2011), so that on
// reversed bits it is an Owen scrambling. Vegdahl's constants: half of the bits above change with any bit.
static inline u32 owen_hash(u32 x, u32 seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  return x ^ x * 0x53a22864u;
}

// Samples that a sequence has before it begins again.
#define SOBOL_SAMPLES 65536u

// Direction numbers of two dimensions (in the low and the high 16 bits), reversed: a column for each bit of
// the reversed index, by fours: COLUMNS(first bit, columns of this bit and of the three behind it) is their
// sum (mod 2) for an index. The dimensions 0 and 1: van der Corput, and x + 1.
#define SOBOL_PAIR_01(COLUMNS)                                      \
  (COLUMNS(0, 0xffff8000u, 0x55554000u, 0x33332000u, 0x11111000u) ^ \
   COLUMNS(4, 0x0f0f0800u, 0x05050400u, 0x03030200u, 0x01010100u) ^ \
   COLUMNS(8, 0x00ff0080u, 0x00550040u, 0x00330020u, 0x00110010u) ^ \
   COLUMNS(12, 0x000f0008u, 0x00050004u, 0x00030002u, 0x00010001u))

// The dimensions 2 and 3: x^2 + x + 1 with 1, 3, and x^3 + x + 1 with 1, 1, 3, which fill each eighth of a
// square in its first eight samples.
#define SOBOL_PAIR_23(COLUMNS)                                      \
  (COLUMNS(0, 0xb082aa09u, 0x60417706u, 0x203f3903u, 0x10151601u) ^ \
   COLUMNS(4, 0x0ff409aau, 0x05530677u, 0x02f60339u, 0x01920116u) ^ \
   COLUMNS(8, 0x008900a3u, 0x00470071u, 0x003d003au, 0x00140017u) ^ \
   COLUMNS(12, 0x000b0009u, 0x00060006u, 0x00020003u, 0x00010001u))

// Of the index `order`, which may be a vector.
#define SOBOL_COLUMN(bit, column) ((column) & (0u - ((order >> (bit)) & 1u)))
#define SOBOL_COLUMNS(bit, a, b, c, d)                                              \
  (SOBOL_COLUMN(bit, a) ^ SOBOL_COLUMN((bit) + 1, b) ^ SOBOL_COLUMN((bit) + 2, c) ^ \
   SOBOL_COLUMN((bit) + 3, d))
static inline u32 sobol_pair_01(u32 order) { return SOBOL_PAIR_01(SOBOL_COLUMNS); }
static inline u32 sobol_pair_23(u32 order) { return SOBOL_PAIR_23(SOBOL_COLUMNS); }

// The reversed index, 16 bits, of the sample in a sequence that is shuffled by `seed`: aligned runs of 2^k
// samples stay such runs.
static inline u32 sobol_order(u32 sample, u32 seed) {
  return owen_hash(reversed_bits(sample) >> 16, seed) & 0xffffu;
}

// Owen's scrambling of the reversed 16 bits of dimension `component`; the 32 bits of a number in [0, 1).
static inline u32 sobol_scrambled(u32 reversed, u32 seed, u32 component) {
  return reversed_bits(owen_hash(reversed & 0xffffu, hash_u32(seed + 0x9e3779b9u * (component + 1u))));
}

// The bits of a pixel's sample in one dimension; [0, 1) are 2^32 of them.
static inline u32 sobol_bits(u32 x, u32 y, u32 sample, u32 dimension) {
  const u32 seed = hash_pixel(x, y, dimension >> 2), order = sobol_order(sample, seed);
  const u32 pair = dimension & 2u ? sobol_pair_23(order) : sobol_pair_01(order);
  return sobol_scrambled(dimension & 1u ? pair >> 16 : pair, seed, dimension & 3u);
}

// Blue noise on the screen: the pixels in Z-order take runs of 2^room samples of one sequence, the first two
// dimensions of Sobol's, shuffled anew for every two dimensions (Ahmed and Wonka 2020, "Screen-Space
// Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels"; pbrt's
// ZSobolSampler, here shuffled as above). Blocks of pixels together then have their samples spread evenly, so
// errors of neighbours cancel.

// The bits of x and of y in turn. Both may be vectors.
#define SPREAD_STEP(v, shift, mask) (((v) | ((v) << (shift))) & (mask))
#define SPREAD_BITS(v)                                                                                      \
  SPREAD_STEP(                                                                                              \
      SPREAD_STEP(SPREAD_STEP(SPREAD_STEP((v) & 0xffffu, 8, 0x00ff00ffu), 4, 0x0f0f0f0fu), 2, 0x33333333u), \
      1, 0x55555555u)
#define Z_ORDER(x, y) (SPREAD_BITS(x) | SPREAD_BITS(y) << 1)

// The reversed index in the sequence; of pictures that are too large for its 2^32 samples the greatest bits
// of the pixels' order are left out.
static inline u32 blue_noise_order(u32 x, u32 y, u32 sample, u32 room, u32 dimension) {
  return owen_hash(reversed_bits(Z_ORDER(x, y) << room | sample), hash_u32(dimension >> 1));
}

// Sobol's second dimension for a reversed index: Pascal's triangle, modulo 2.
static inline u32 sobol_second(u32 order) {
  order ^= order << 16;
  order ^= (order & 0x00ff00ffu) << 8;
  order ^= (order & 0x0f0f0f0fu) << 4;
  order ^= (order & 0x33333333u) << 2;
  return order ^ (order & 0x55555555u) << 1;
}

// As sobol_bits().
static inline u32 blue_noise_bits(u32 x, u32 y, u32 sample, u32 room, u32 dimension) {
  const u32 order = blue_noise_order(x, y, sample, room, dimension);
  const u32 place = dimension & 1u ? sobol_second(order) : order;
  return reversed_bits(owen_hash(reversed_bits(place), hash_u32(dimension + 0x9e3779b9u)));
}

SUNDOG_SHARED_END
#endif
