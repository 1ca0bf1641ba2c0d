// A response to instructions. Each statement leaves the registers free; what has to last (counters
// of loops, what DEFINEs are given) is in locals of its own.
#pragma once

#include "compiler/codegen/expression_emitter.hpp"

namespace robosync::compiler {

struct ResponseCode {
  CodeDraft code;
  std::uint32_t actuators = 0;  // every actuator that it can command
};

// Is it known only on the robot what the variable will be?
[[nodiscard]] bool needs_clamping(const ProgramSet& set);

class ResponseEmitter {
public:
  explicit ResponseEmitter(Parts& parts)
      : parts_(parts), expressions_(parts, response_.code, TimeWords::watched) {}
  ResponseEmitter(const ResponseEmitter&) = delete;
  ResponseEmitter& operator=(const ResponseEmitter&) = delete;

  // Once for each emitter.
  [[nodiscard]] ResponseCode emit(const ProgramBlock& block);

private:
  using Opcode = vm::Opcode;

  void block(const ProgramBlock& statements);
  void statement(const ProgramStatement& statement);
  // response_emitter.cpp
  void emit(const ProgramCommand& command);
  void emit(const ProgramLocal& local);
  void emit(const ProgramSet& set);
  void emit(const ProgramWait& wait);
  void emit(const ProgramThen& then);
  void emit(const ProgramLog& log);
  void emit(const ProgramAlert& alert);
  void emit(const ProgramHalt& halt);
  void argument(vm::Param param, const Expression& value);
  // response_blocks.cpp
  void emit(const ProgramWaitUntil& wait);
  void emit(const ProgramIf& choice);
  void emit(const ProgramRepeat& repeat);
  void emit(const ProgramPick& pick);
  void write_ahead(const ProgramRepeat& repeat);
  void repeat_times(const ProgramRepeat& repeat);
  void repeat_constant_times(const ProgramRepeat& repeat);
  void repeat_forever(const ProgramRepeat& repeat);
  void repeat_while(const ProgramRepeat& repeat);
  void options(const ProgramPick& pick, Cell drawn);
  // Emits what begins a block; gives its place, for the jump that ends there.
  std::size_t open(Opcode opcode, Operand a = {}, Operand b = {});
  // Opens a block that runs if the condition is true.
  std::size_t open_unless(const Expression& condition);
  std::size_t open_unless(Operation comparison, Cell left, vm::Value right);
  // The same, as one block in the other for each part of an AND; the outermost comes first.
  std::vector<std::size_t> open_unless_all(const Expression& condition);
  // One more block is open.
  void count_block();
  // Ends the block that began at `begin`, and begins its ELSE; gives the place of that.
  std::size_t otherwise(std::size_t begin);
  // The same where the block around both ends in the same place: it takes the ELSE in.
  std::size_t otherwise_to_same_end(std::size_t begin);
  void close(std::size_t begin);  // of a block that ends here
  // Ends a loop or the evaluation of a wait by `opcode`, which may go back to its start.
  void close_around(Opcode opcode, Operand a, std::size_t begin);

  CodeDraft& code() { return response_.code; }
  // What is emitted from now on comes from the current statement.
  void mark() { code().mark({current_->line, current_->span}); }

  Parts& parts_;
  ResponseCode response_;
  ExpressionEmitter expressions_;
  const ProgramStatement* current_ = nullptr;  // never null while a statement is emitted
  unsigned open_blocks_ = 0;
};

}  // namespace robosync::compiler
