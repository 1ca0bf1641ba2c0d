// imu_gestures: what an accelerometer says about how a body is held and moved. At rest it reads 0, 0, 1 g: X points
// forward, Y to the left, Z up.
//
// The lasting part of the acceleration is gravity, found by a low-pass filter of GRAVITY_MS; the rest is motion.
// LEVEL is the jerk, which is how fast the acceleration changes, summed over the axes, in whole g per second. It rises
// immediately and fades within JERK_MS.
// GESTURE is what was last done to the body, shown for `shown_for`:
//   falling  nothing holds it: all axes are near 0 for `fall_time`, and it lasts as long as they are
//   shaken   its motion along one axis was above `shake` in alternate directions, `shakes` times, at most SWING_MS apart
//   tapped   its motion, summed over the axes, was above `tap` for at most SPIKE_MS, and calmer for QUIET_MS afterwards
//   lifted   its motion was above `lift` upwards, and mostly upwards, for LIFT_MS, and not downwards just before: that is
//            how putting it down ends
// A body that is shaken does not count as tapped: tapped and lifted count only while nothing else is shown.
// TILT is how it is held, determined while it is calm.
#include <stddef.h>

#include "runtime-m4/algorithms/robosync_module.h"

enum { X, Y, Z, AXES };
enum { LEVEL, GESTURE, TILT, OUTPUTS };
enum { TAP, SHAKE, SHAKES, LIFT, LEAN, FALL_TIME, SHOWN_FOR, PARAMETERS };
enum { GESTURE_NONE, FALLING, SHAKEN, TAPPED, LIFTED };
enum { UPRIGHT, FORWARD, BACK, LEFT, RIGHT, UPSIDE_DOWN };

enum { GRAVITY_MS = 320, JERK_MS = 80, SWING_MS = 400, SPIKE_MS = 60, QUIET_MS = 120 };
enum { LIFT_MS = 100, AFTER_SINKING_MS = 600, FOREVER_MS = 1000000 };
enum { MOST = 16000, NEAR_NOTHING = 300, CALM = 150, LEAN_MARGIN = 100 };  // thousandths of g
enum { FINE = 64 };  // parts of a thousandth: in a short period gravity may change by less than one

typedef struct state {
  int32_t last[AXES], motion[AXES];
  int32_t gravity[AXES];  // times FINE
  int32_t jerk;           // thousandths of g per second
  uint32_t period_ms;
  uint32_t falling_ms, swing_ms, loud_ms, quiet_ms, rising_ms, sinking_ms, shown_ms;  // time since
  uint8_t begun, axis, forth, swings, gesture, tilt;
} state;

static uint32_t state_bytes(const int32_t* config) {
  (void)config;
  return sizeof(state);
}

static uint32_t cost(const int32_t* config) {
  (void)config;
  return 440;
}

static void init(void* memory, const int32_t* config, uint32_t period_ms) {
  (void)config;
  state* self = memory;
  *self = (state){.period_ms = period_ms, .sinking_ms = FOREVER_MS};
}

static int32_t size_of(int32_t value) {
  return value < 0 ? -value : value;
}

static int32_t clamped(int32_t value) {
  if (value > MOST) return MOST;
  return value < -MOST ? -MOST : value;
}

static uint32_t later(uint32_t since_ms, uint32_t period_ms) {
  return since_ms < FOREVER_MS ? since_ms + period_ms : since_ms;
}

static void measure(state* self, const int32_t* inputs) {
  const int32_t period = (int32_t)self->period_ms;
  int32_t change = 0;
  for (int i = 0; i < AXES; ++i) {
    const int32_t now = clamped(inputs[i]);
    if (!self->begun) {
      self->last[i] = now;
      self->gravity[i] = now * FINE;
    }
    change += size_of(now - self->last[i]);
    self->last[i] = now;
    self->motion[i] = now - self->gravity[i] / FINE;
    self->gravity[i] += (now * FINE - self->gravity[i]) * period / GRAVITY_MS;
  }
  self->begun = 1;
  self->jerk -= self->jerk * period / JERK_MS;
  const int32_t jerk = change * 1000 / period;
  if (jerk > self->jerk) self->jerk = jerk;
}

static int32_t strength(const state* self) {
  return size_of(self->motion[X]) + size_of(self->motion[Y]) + size_of(self->motion[Z]);
}

static int is_falling(state* self, const int32_t* config) {
  int64_t square = 0;
  for (int i = 0; i < AXES; ++i)
    square += (int64_t)self->last[i] * self->last[i];
  const int is_weightless = square < (int64_t)NEAR_NOTHING * NEAR_NOTHING;
  self->falling_ms = is_weightless ? later(self->falling_ms, self->period_ms) : 0;
  return self->falling_ms >= (uint32_t)config[FALL_TIME];
}

static uint8_t strongest_axis(const state* self) {
  int axis = X;
  for (int i = Y; i < AXES; ++i)
    if (size_of(self->motion[i]) > size_of(self->motion[axis])) axis = i;
  return (uint8_t)axis;
}

// The first swing determines the axis of the others.
static int is_shaken(state* self, const int32_t* config) {
  self->swing_ms = later(self->swing_ms, self->period_ms);
  if (self->swing_ms > SWING_MS) self->swings = 0;
  if (self->swings == 0) self->axis = strongest_axis(self);
  const int32_t motion = self->motion[self->axis];
  const uint8_t forth = motion > 0;
  if (size_of(motion) <= config[SHAKE]) return 0;
  if (self->swings != 0 && forth == self->forth) return 0;
  ++self->swings;
  self->forth = forth;
  self->swing_ms = 0;
  if (self->swings < config[SHAKES] / ROBOSYNC_ONE) return 0;
  self->swings = 1;
  return 1;
}

static int is_tapped(state* self, const int32_t* config) {
  if (strength(self) > config[TAP]) {
    self->loud_ms = later(self->loud_ms, self->period_ms);
    self->quiet_ms = 0;
  } else if (self->loud_ms != 0) {
    self->quiet_ms += self->period_ms;
  }
  if (self->quiet_ms < QUIET_MS) return 0;
  const int is_short = self->loud_ms <= SPIKE_MS;
  self->loud_ms = 0;
  self->quiet_ms = 0;
  return is_short;
}

// The motion along gravity, whose length is about 1 g.
static int32_t upwards(const state* self) {
  int64_t sum = 0;
  for (int i = 0; i < AXES; ++i)
    sum += (int64_t)self->motion[i] * (self->gravity[i] / FINE);
  return (int32_t)(sum / ROBOSYNC_ONE);
}

static int is_lifted(state* self, const int32_t* config) {
  const int32_t up = upwards(self);
  const int is_rising = up > config[LIFT] && 2 * up > strength(self);
  self->sinking_ms = up < -config[LIFT] ? 0 : later(self->sinking_ms, self->period_ms);
  if (is_rising && self->sinking_ms >= AFTER_SINKING_MS)
    self->rising_ms = later(self->rising_ms, self->period_ms);
  else
    self->rising_ms = 0;
  return self->rising_ms >= LIFT_MS;
}

static void note_gesture(state* self, const int32_t* config) {
  const int falling = is_falling(self, config);
  const int shaken = is_shaken(self, config);
  const int tapped = is_tapped(self, config);
  const int lifted = is_lifted(self, config);
  const uint8_t shown = self->gesture;
  uint8_t gesture = GESTURE_NONE;
  if (falling) {
    gesture = FALLING;
  } else if (shaken) {
    gesture = SHAKEN;
  } else if (tapped && (shown == GESTURE_NONE || shown == TAPPED)) {
    gesture = TAPPED;
  } else if (lifted && (shown == GESTURE_NONE || shown == LIFTED)) {
    gesture = LIFTED;
  }
  if (gesture != GESTURE_NONE) {
    self->gesture = gesture;
    self->shown_ms = 0;
    return;
  }
  self->shown_ms = later(self->shown_ms, self->period_ms);
  if (self->shown_ms >= (uint32_t)config[SHOWN_FOR]) self->gesture = GESTURE_NONE;
}

static int leans(int32_t gravity, int32_t least, int leant) {
  return gravity > (leant ? least - LEAN_MARGIN : least);
}

// The axis that points down reads gravity as negative.
static uint8_t tilt_of(const state* self, int32_t least) {
  const int32_t x = self->gravity[X] / FINE;
  const int32_t y = self->gravity[Y] / FINE;
  if (size_of(x) >= size_of(y)) {
    if (leans(-x, least, self->tilt == FORWARD)) return FORWARD;
    if (leans(x, least, self->tilt == BACK)) return BACK;
  } else {
    if (leans(-y, least, self->tilt == LEFT)) return LEFT;
    if (leans(y, least, self->tilt == RIGHT)) return RIGHT;
  }
  return self->gravity[Z] < 0 ? UPSIDE_DOWN : UPRIGHT;
}

static uint32_t imu_gestures_process(void* memory, void* scratch, const robosync_block* block) {
  (void)scratch;
  state* self = memory;
  measure(self, block->inputs);
  note_gesture(self, block->config);
  if (strength(self) < CALM) self->tilt = tilt_of(self, block->config[LEAN]);
  return robosync_put(block, LEVEL, self->jerk / ROBOSYNC_ONE * ROBOSYNC_ONE) |
         robosync_put(block, GESTURE, self->gesture * ROBOSYNC_ONE) |
         robosync_put(block, TILT, self->tilt * ROBOSYNC_ONE);
}

static const robosync_range ranges[PARAMETERS] = {
    [TAP] = {1000, 200, 16000},     [SHAKE] = {700, 200, 16000}, [SHAKES] = {4000, 2000, 20000},
    [LIFT] = {150, 50, 2000},       [LEAN] = {500, 150, 950},    [FALL_TIME] = {100, 40, 1000},
    [SHOWN_FOR] = {500, 20, 60000},
};

const robosync_module imu_gestures_module = {
    .inputs = AXES,
    .outputs = OUTPUTS,
    .parameters = PARAMETERS,
    .shortest_period_ms = 5,
    .longest_period_ms = 20,
    .ranges = ranges,
    .state_bytes = state_bytes,
    .scratch_bytes = robosync_no_scratch,
    .cost = cost,
    .init = init,
    .process = imu_gestures_process,
};

static const robosync_input inputs[AXES] = {
    {"X", ROBOSYNC_G}, {"Y", ROBOSYNC_G}, {"Z", ROBOSYNC_G}};

static const char* const gestures[] = {"none", "falling", "shaken", "tapped", "lifted"};
static const char* const tilts[] = {"upright", "forward", "back", "left", "right", "upside_down"};

static const robosync_output outputs[OUTPUTS] = {
    [LEVEL] = {"LEVEL", ROBOSYNC_NUMBER, 0, 20000000, NULL, 0},
    [GESTURE] = {"GESTURE", ROBOSYNC_NUMBER, 0, 4000, gestures, 5},
    [TILT] = {"TILT", ROBOSYNC_NUMBER, 0, 5000, tilts, 6},
};

static const robosync_parameter parameters[PARAMETERS] = {
    [TAP] = {"tap", ROBOSYNC_G},
    [SHAKE] = {"shake", ROBOSYNC_G},
    [SHAKES] = {"shakes", ROBOSYNC_COUNT},
    [LIFT] = {"lift", ROBOSYNC_G},
    [LEAN] = {"tilt", ROBOSYNC_G},
    [FALL_TIME] = {"fall_time", ROBOSYNC_SECONDS},
    [SHOWN_FOR] = {"shown_for", ROBOSYNC_SECONDS},
};

ROBOSYNC_DESCRIBE(imu_gestures, 20, inputs, outputs, parameters)
