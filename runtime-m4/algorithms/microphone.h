// The inputs of a module that listens: the channels of stdlib/devices/microphone.json, in order, for 20 ms of sound each time.
#pragma once

#include "runtime-m4/algorithms/robosync_module.h"

enum {
  MICROPHONE_LOUDNESS,
  MICROPHONE_HIGHS,
  MICROPHONE_PITCH,
  MICROPHONE_CLARITY,
  MICROPHONE_INPUTS
};
enum { MICROPHONE_PERIOD_MS = 20 };

static const robosync_input microphone_inputs[MICROPHONE_INPUTS] = {
    [MICROPHONE_LOUDNESS] = {"LOUDNESS", ROBOSYNC_DECIBEL},
    [MICROPHONE_HIGHS] = {"HIGHS", ROBOSYNC_DECIBEL},
    [MICROPHONE_PITCH] = {"PITCH", ROBOSYNC_HERTZ},
    [MICROPHONE_CLARITY] = {"CLARITY", ROBOSYNC_PERCENT},
};
