// The city of boxes.c in the evening: a low sun that is as wide as its soft shadows, light from the sky, and lit
// windows. Each pixel has four samples of up to three rays. docs/tutorial.md shows the picture.
enum { SAMPLES = 4 };

static const struct vector sun = {0.85f, 0.30f, 0.10f};

static inline struct vector mix(struct vector a, struct vector b, float t) {
  return (struct vector){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

// A number from 0 to 1, another one after each call (PCG).
static inline float random_number(unsigned *state) {
  *state = *state * 747796405u + 2891336453u;
  unsigned word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
  return (float)((word >> 22 ^ word) >> 8) * 0x1p-24f;
}

// A point of the ball of radius 1.
static struct vector in_ball(unsigned *state) {
  for (;;) {
    struct vector p = {2 * random_number(state) - 1, 2 * random_number(state) - 1, 2 * random_number(state) - 1};
    if (p.x * p.x + p.y * p.y + p.z * p.z < 1)
      return p;
  }
}

// The sky from the horizon up, by the height of a direction of about length 1.
static struct vector sky_of(float height) {
  float t = fminf(fmaxf(height, 0) * 2.2f, 1);
  return mix((struct vector){1.0f, 0.50f, 0.24f}, (struct vector){0.12f, 0.20f, 0.50f}, t);
}

// A window of a wall has light in two of five cases; across and up are in floors.
static int is_lit(const struct box *box, float across, float up) {
  float column = __builtin_floorf(across), floor = __builtin_floorf(up);
  float u = across - column, v = up - floor;
  unsigned state = (unsigned)(box - boxes) * 7919u + (unsigned)(int)(column + 64) * 104729u + (unsigned)(int)floor;
  return u > 0.25f && u < 0.75f && v > 0.3f && v < 0.8f && random_number(&state) < 0.4f;
}

// The light that arrives from the direction d.
static struct vector light_from(struct vector d, unsigned *state) {
  float t, ignored;
  const struct box *box = trace(eye, d, &t);
  if (!box)
    return sky_of(d.y + 0.25f);
  struct vector p = {eye.x + t * d.x, eye.y + t * d.y, eye.z + t * d.z}, n = {0, 0, 0};
  // The side that was hit is the one that the point is nearest to.
  float dx = fminf(fabsf(p.x - box->low.x), fabsf(p.x - box->high.x));
  float dy = fminf(fabsf(p.y - box->low.y), fabsf(p.y - box->high.y));
  float dz = fminf(fabsf(p.z - box->low.z), fabsf(p.z - box->high.z));
  if (dy < dx && dy < dz)
    n.y = 1;
  else if (dx < dz)
    n.x = d.x > 0 ? -1 : 1;
  else
    n.z = d.z > 0 ? -1 : 1;
  if (box > boxes && n.y == 0 && is_lit(box, 6 * (n.x != 0 ? p.z : p.x), 6 * p.y))
    return (struct vector){1.2f, 0.80f, 0.30f};

  struct vector above = {p.x + 1e-3f * n.x, p.y + 1e-3f * n.y, p.z + 1e-3f * n.z};
  struct vector wide = in_ball(state), sum = {0, 0, 0};
  struct vector to_sun = {sun.x + 0.05f * wide.x, sun.y + 0.05f * wide.y, sun.z + 0.05f * wide.z};
  float cosine = n.x * to_sun.x + n.y * to_sun.y + n.z * to_sun.z;
  if (cosine > 0 && !trace(above, to_sun, &ignored))
    sum = (struct vector){1.9f * cosine, 0.85f * cosine, 0.30f * cosine};
  struct vector ball = in_ball(state), up = {n.x + ball.x, n.y + ball.y, n.z + ball.z};
  if (up.y > 0 && !trace(above, up, &ignored)) {
    struct vector sky = sky_of(up.y);
    sum = (struct vector){sum.x + sky.x, sum.y + sky.y, sum.z + sky.z};
  }
  float paint = box == boxes ? 0.35f : 0.35f + 0.08f * (float)((box - boxes) % 5);
  return (struct vector){paint * sum.x, paint * sum.y, paint * sum.z};
}

static unsigned level_of(float light) {
  return (unsigned)(255 * __builtin_sqrtf(fminf(light * (1.0f / SAMPLES), 1)));
}

static unsigned colour_of(unsigned pixel) {
  unsigned state = pixel;
  struct vector sum = {0, 0, 0};
  for (unsigned sample = 0; sample < SAMPLES; sample++) {
    float right = (float)(pixel % WIDTH) + 0.25f + 0.5f * (float)(sample & 1);
    float down = (float)(pixel / WIDTH) + 0.25f + 0.5f * (float)(sample >> 1);
    float x = right * (1.2f / WIDTH) - 0.6f, y = 0.3375f - down * (0.675f / HEIGHT);
    struct vector d = {0.53f + 0.82f * x + 0.21f * y, -0.37f + 0.93f * y, -0.76f + 0.57f * x - 0.30f * y};
    struct vector light = light_from(d, &state);
    sum = (struct vector){sum.x + light.x, sum.y + light.y, sum.z + light.z};
  }
  return level_of(sum.x) | level_of(sum.y) << 8 | level_of(sum.z) << 16 | 0xff000000; // R, G, B, A
}
