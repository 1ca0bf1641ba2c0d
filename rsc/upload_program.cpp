// See upload_program.hpp.
#include "rsc/upload_program.hpp"

#include <fmt/format.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace {

void check_board(const Session& session, const Program& program) {
  const std::vector<std::string> found = obstacles(session.board, program.image());
  if (found.empty()) return;
  throw Failure(Exit::program,
                fmt::format("the board ({}, firmware {}) cannot run this program:\n  {}",
                            text_of(session.board.board), text_of(session.board.firmware),
                            fmt::join(found, "\n  ")));
}

void check_result(const link::ActivateResult& result, const Program& program) {
  if (result.running != 0) return;
  if (result.refusal == link::kNothingToActivate) {
    throw Failure(Exit::outside, "the board lost the transfer again and again; is it being reset?");
  }
  const vm::Verdict verdict{static_cast<vm::Refusal>(result.refusal),
                            static_cast<vm::Section>(result.section), result.index};
  const std::uint16_t line = source_line(program.image(), verdict.section, verdict.index);
  throw Failure(Exit::program, fmt::format("the board refused the program: {}; the old one goes on",
                                           describe_refusal(verdict, line)));
}

}  // namespace

UploadResult upload_program(Session& session, const Program& program,
                            const UploadOptions& options) {
  check_board(session, program);
  const UploadResult result =
      upload(session.client, session.board, without_source_lines(program), options);
  check_result(result.activation, program);
  return result;
}

}  // namespace robosync::tool
