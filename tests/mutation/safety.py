"""scripts/mutate safety: the safety monitor, its rules and the output guard, broken on purpose, one promise at a time (changes.py); of the
tests of the layers those run that are about safety."""

import sys

from changes import Mutant, Suite, run

TESTS = "[#guard_test],[#outputs_test],[#safety_test],[#stop_test],[#faults_test],[#analog_input_test],[#pca9685_test],[#player_test],[#ssd1306_test],[#ws2812_test]"
GUARD, RULES = "runtime-m4/guard/output_guard.cpp", "runtime-m4/safety/safety_rules.cpp"
MAILBOX, REGION = "runtime-m4/layers/mailbox.cpp", "runtime-m4/layers/safety_region.cpp"
MONITOR, CONTROL, RUNTIME = "runtime-m4/safety/monitor.cpp", "runtime-m4/layers/control.cpp", "runtime-m4/runtime.cpp"

MUTANTS = (
    Mutant("a halt does not shut the pin to drivers", GUARD, "halted_ |= actuators;\n  free_ = owned_ & ~halted_;",
           "halted_ |= actuators;"),
    Mutant("a halt leaves the pulse as it is", GUARD, "slot.pulse = slot.target = slot.safe;\n  board_.pwm_write(slot.pin, slot.safe);", ""),
    Mutant("a halt leaves a pulse that changes slowly as it is", GUARD, "if (slot.safe != kStays && slot.pulse != 0) return", "if (false) return"),
    Mutant("a halt makes what was off begin to move", GUARD, "  if (slot.pulse == 0) return;\n", ""),
    Mutant("a halt makes what was off, and changes slowly, begin to move", GUARD, "slot.safe != kStays && slot.pulse != 0",
           "slot.safe != kStays"),
    Mutant("a halt moves what shall stay", GUARD, "(gradual_ | apart_)", "gradual_"),
    Mutant("a halt moves at once what changes slowly", GUARD, "(gradual_ | apart_)", "apart_"),
    Mutant("letting one go lets all go", GUARD, "halted_ &= ~actuators;", "halted_ = 0;"),
    Mutant("an upload ends a stop for the guard", GUARD, "halted_ = halted;", "halted_ = 0;"),
    Mutant("a program that comes while all is stopped is as it was", GUARD, "  make_halted_safe(kernel_.now());\n", ""),
    Mutant("a pin that is measured stays let go", GUARD, "board_.take_back(static_cast<std::uint16_t>(std::countr_zero(left)));", ";"),
    Mutant("the next program leaves on what it does not have", GUARD, "next == nullptr || !drives(*next, slot)",
           "next == nullptr"),
    Mutant("a motor runs on before the next program's rules know", GUARD, " || moves) switch_off(slot);", ") switch_off(slot);"),
    Mutant("an order during a halt moves a servo of a chip after it", GUARD, "if (is_free(actuator)) limp_ &=", "limp_ &="),
    Mutant("without a program pins stay on", GUARD, "next == nullptr || ", "next != nullptr && "),
    Mutant("who does not own a pin may drive it", GUARD, "return (free_ & bit(actuator)) != 0;",
           "return (halted_ & bit(actuator)) == 0;"),
    Mutant("no limit of the pulse", GUARD, "settle(slot, actuator, within(limits_[slot.limit], pulse_us), now)",
           "settle(slot, actuator, static_cast<std::uint16_t>(pulse_us), now)"),
    Mutant("no limit of the safe state's pulse", GUARD, "within(limit, *safe)", "static_cast<std::uint16_t>(*safe)"),
    Mutant("no limit of the rise", GUARD, "if ((gradual_ & bit(actuator)) != 0) [[unlikely]]", "if (false)"),
    Mutant("a pin that may rise at once has its rise limited once another has", GUARD, "  gradual_ = apart_ = 0;\n", "  apart_ = 0;\n"),
    Mutant("no limit of the power of a motor", GUARD, "within(limits_[slot.limit], length)", "static_cast<std::uint16_t>(length)"),
    Mutant("a motor that turns round has both pins on", GUARD, "board_.pwm_write(slot.pin, 0);\n  exchange(slot);", "exchange(slot);"),
    Mutant("a motor that turns round begins at the power of before", GUARD, "  slot.pulse = 0;\n", ""),
    Mutant("a halt lets a player play on", GUARD, "    slot.target = 0;\n    if (is_on_panel", "    if (is_on_panel"),
    Mutant("a player is told twice at once", GUARD, "- slot.changed) < gap;", "- slot.changed) == 0xFFFF;"),
    Mutant("who is halted may play", GUARD, "if (!is_free(actuator) || !vm::drives_player(slot.driver)) return;",
           "if (!vm::drives_player(slot.driver)) return;"),
    Mutant("without a program a player plays on", GUARD, "say(*ended_player_, 0);",
           "say(*ended_player_, ended_player_->target);"),
    Mutant("a halt leaves the picture on a panel", GUARD, "if (is_on_panel(slot.driver)) on_panel_ = 0;", ";"),
    Mutant("a halt takes the picture from a panel that holds it", GUARD, "    if (slot.safe == kStays) return;\n", ""),
    Mutant("without a program a panel stays lit", GUARD, "    board_.panel().show(0);\n", "    ;\n"),
    Mutant("the next program finds the panel lit", GUARD, "    on_panel_ = 0;\n    board_.panel().begin", "    board_.panel().begin"),
    Mutant("a panel keeps its pin when another program drives it", GUARD, "if (boards::kHasPanel) free_panel_pin(image);", ""),
    Mutant("a motor's pins the other way round are the same to an upload", GUARD, "(second == kNoPin || actuator.bus == second)", "true"),
    Mutant("a motor that runs backward is not seen by the next program", GUARD, "if (back == 0) return slot;", "return slot;"),
    Mutant("a halt leaves a servo chip on", GUARD, "  if ((actuators & on_chips_) != 0) halt_chips(actuators);\n", ""),
    Mutant("a servo chip goes on during a halt", GUARD,
           "  if (!chip->holds && (chip->actuators & halted_) != 0) return;\n", ""),
    Mutant("what went limp with its chip goes on without an order", GUARD, "  limp_ |= chip.actuators;\n", ""),
    Mutant("the next program finds a servo chip on", GUARD, "    board_.enable(chips_[c].enable, false);\n", "    ;\n"),
    Mutant("a lost servo chip stays on", GUARD, "  chip->known = false;\n  switch_chip_off(*chip);", "  chip->known = false;"),
    Mutant("a halt leaves the picture on a display", GUARD, "!display.holds) display.picture = 0;", "!display.holds) display.picture += 0;"),
    Mutant("what is fed is not delivered before the rules are looked at", RUNTIME, "if (begun_ && !sensors_.are_fed())",
           "if (begun_)"),
    Mutant("a reading is never too old", RULES, "if (!mailboxes.are_fresh(tick)) [[unlikely]]", "if (false)"),
    Mutant("nobody knows when the first reading of a channel is too old", MAILBOX,
           "if (!was_known) expires_by(expires_at(number, channel));", ""),
    Mutant("nobody knows that a channel is not measured any more", MAILBOX, "  expires_by(0);\n", ""),
    Mutant("nobody knows when others are too old, once one was", MAILBOX, "next = std::min(next, expires_at(c, channels[c]));", ""),
    Mutant("what is unknown does not trip", RULES, "danger != vm::kFalse", "danger == vm::kTrue"),
    Mutant("a rule resumes while it is in danger", RULES, "was_tripped && danger == vm::kFalse && ", "was_tripped && "),
    Mutant("a rule lets go what another one halts", RULES, "halted_by(rule) & ~still", "halted_by(rule)"),
    Mutant("a rule stops what its damaged code says", RULES, "actuators_of(program_->image, said.target) & halted",
           "actuators_of(program_->image, said.target)"),
    Mutant("the end of what SAFETY's bytecode puts out is believed", REGION, "bytes <= output.size_bytes() ? bytes / sizeof(vm::Word) : 0",
           "bytes / sizeof(vm::Word)"),
    Mutant("the guard is told of a trip with the rest, not first", RULES,
           "if (trips) layers_.outputs.halt(halted_by(rule));", "",
           "the rule's body halts the same right behind it; the figure safety/reading_to_safe knows"),
    Mutant("a hung program is kicked for", MONITOR, "if (without_progress_ < kChecksUntilHung) {",
           "if (without_progress_ == kChecksUntilHung) supervised_.halt(kChecksUntilHung * kPeriod);\n  if (true) {"),
    Mutant("a hung program is not halted", MONITOR, "supervised_.halt(kChecksUntilHung * kPeriod);", ";"),
    Mutant("rules are not looked at when nothing is new", MONITOR, "(why & kNews) != 0 || kernel_.now() >= std::min(due, rules_due)",
           "(why & kNews) != 0"),
    Mutant("a person's stop is not heard", MONITOR, "if ((why & kPerson) != 0) supervised_.obey();", ""),
    Mutant("slow changes do not go on", MONITOR, "supervised_.tend_outputs();", ""),
    Mutant("a resume lets go what rules halt", CONTROL, "set_free(halted() & ~by_rules_)", "set_free(halted())"),
    Mutant("a rule's end ends a stop", CONTROL, "if (!stopped_) return set_free", "return set_free"),
    Mutant("a rule's end lets go what hung", CONTROL, "  if (for_good_) return;\n", ""),
    Mutant("a stop does not hold for the next program", CONTROL, "halted_ = stopped_ ? all() : 0;", "halted_ = 0;"),
    Mutant("a thread that stopped leaves its pin on", CONTROL, "outputs_.halt(bit<ActuatorMask>(actuator));", "",
           "its driver puts it into the safe state as well, and nobody else drives it"),
    Mutant("the program begins before the rules know", RUNTIME, "if (!begun_ && !sensors_.knows_enough()) {", "if (false) {"),
)

SUITE = Suite("robosync_runtime", "tests/runtime-m4/test_layers", TESTS, MUTANTS)

if __name__ == "__main__":
    sys.exit(run(SUITE))
