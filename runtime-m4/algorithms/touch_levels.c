// touch_levels: what a touch sensor's level says about a touch.
//
// LEVEL is the band that the level is in: none, light, firm. A band is left when the level is `margin` below where
// the band begins, so that a trembling hand does not make it flicker.
// TOUCH is the kind of touch. One that ends within `tap_time` was a tap, or a pat if it was firm at
// any time; it is shown for `shown_for`, or until the next touch begins. One that has lasted for `stroke_time` is a
// stroke until it ends. A touch that ends in between is none of these.
#include <stddef.h>

#include "runtime-m4/algorithms/robosync_module.h"

enum { LEVEL, TOUCH, OUTPUTS };
enum { LIGHT, FIRM, MARGIN, TAP_TIME, STROKE_TIME, SHOWN_FOR, PARAMETERS };
enum { BAND_NONE, BAND_LIGHT, BAND_FIRM };
enum { TOUCH_NONE, TOUCH_TAP, TOUCH_PAT, TOUCH_STROKE };

typedef struct state {
  uint32_t period_ms;
  uint32_t touched_ms;  // time since the touch began, at the next sample; 0: no touch
  uint32_t shown_ms;    // time since TOUCH became a tap or a pat
  uint8_t band, touch;
  uint8_t was_firm;  // in this touch
} state;

static uint32_t state_bytes(const int32_t* config) {
  (void)config;
  return sizeof(state);
}

static uint32_t cost(const int32_t* config) {
  (void)config;
  return 80;
}

static void init(void* memory, const int32_t* config, uint32_t period_ms) {
  (void)config;
  state* self = memory;
  *self = (state){.period_ms = period_ms};
}

static int is_above(int32_t level, int32_t threshold, int32_t margin, int was_above) {
  return level >= threshold || (was_above && (int64_t)level + margin > threshold);
}

static uint8_t band_of(int32_t level, uint8_t last, const int32_t* config) {
  if (is_above(level, config[FIRM], config[MARGIN], last == BAND_FIRM)) return BAND_FIRM;
  if (is_above(level, config[LIGHT], config[MARGIN], last != BAND_NONE)) return BAND_LIGHT;
  return BAND_NONE;
}

static void go_on(state* self, const int32_t* config) {
  if (self->touched_ms == 0) {
    self->was_firm = 0;
    self->touch = TOUCH_NONE;
  }
  if (self->band == BAND_FIRM) self->was_firm = 1;
  const uint32_t most = UINT32_MAX / 2;
  if (self->touched_ms >= (uint32_t)config[STROKE_TIME]) self->touch = TOUCH_STROKE;
  if (self->touched_ms < most) self->touched_ms += self->period_ms;
}

static void end(state* self, const int32_t* config) {
  self->touch = TOUCH_NONE;
  if (self->touched_ms < (uint32_t)config[TAP_TIME])
    self->touch = self->was_firm ? TOUCH_PAT : TOUCH_TAP;
  self->touched_ms = 0;
  self->shown_ms = 0;
}

static uint32_t touch_levels_process(void* memory, void* scratch, const robosync_block* block) {
  (void)scratch;
  state* self = memory;
  const int32_t* config = block->config;
  self->band = band_of(block->inputs[0], self->band, config);
  if (self->band != BAND_NONE) {
    go_on(self, config);
  } else if (self->touched_ms != 0) {
    end(self, config);
  } else if (self->touch != TOUCH_NONE) {
    self->shown_ms += self->period_ms;
    if (self->shown_ms >= (uint32_t)config[SHOWN_FOR]) self->touch = TOUCH_NONE;
  }
  return robosync_put(block, LEVEL, self->band * ROBOSYNC_ONE) |
         robosync_put(block, TOUCH, self->touch * ROBOSYNC_ONE);
}

static const robosync_range ranges[PARAMETERS] = {
    [LIGHT] = {1000, 1, 1000000000},  [FIRM] = {5000, 1, 1000000000},
    [MARGIN] = {500, 0, 1000000000},  [TAP_TIME] = {300, 20, 5000},
    [STROKE_TIME] = {700, 50, 60000}, [SHOWN_FOR] = {300, 20, 60000},
};

const robosync_module touch_levels_module = {
    .inputs = 1,
    .outputs = OUTPUTS,
    .parameters = PARAMETERS,
    .shortest_period_ms = 2,
    .longest_period_ms = 100,
    .ranges = ranges,
    .state_bytes = state_bytes,
    .scratch_bytes = robosync_no_scratch,
    .cost = cost,
    .init = init,
    .process = touch_levels_process,
};

static const robosync_input inputs[] = {{"LEVEL", ROBOSYNC_AS_INPUT}};

static const char* const bands[] = {"none", "light", "firm"};
static const char* const touches[] = {"none", "tap", "pat", "stroke"};

static const robosync_output outputs[OUTPUTS] = {
    [LEVEL] = {"LEVEL", ROBOSYNC_NUMBER, 0, 2000, bands, 3},
    [TOUCH] = {"TOUCH", ROBOSYNC_NUMBER, 0, 3000, touches, 4},
};

static const robosync_parameter parameters[PARAMETERS] = {
    [LIGHT] = {"light", ROBOSYNC_AS_INPUT},
    [FIRM] = {"firm", ROBOSYNC_AS_INPUT},
    [MARGIN] = {"margin", ROBOSYNC_AS_INPUT},
    [TAP_TIME] = {"tap_time", ROBOSYNC_SECONDS},
    [STROKE_TIME] = {"stroke_time", ROBOSYNC_SECONDS},
    [SHOWN_FOR] = {"shown_for", ROBOSYNC_SECONDS},
};

ROBOSYNC_DESCRIBE(touch_levels, 20, inputs, outputs, parameters)
