// See examples.hpp.
#include "compiler/syntax/examples.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/layout.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

namespace {

struct ShapeKind : Kinds {
  static constexpr TokenKind any = END_OF_FILE;  // begins no line
};

struct LineShape {
  TokenKind first, next, in;
  std::string_view word;  // if `first` is a name: which one; empty: any
  std::string_view example;
};

constexpr LineShape kShapes[] = {
#define LINE(first, next, in, example) \
  {ShapeKind::first, ShapeKind::next, ShapeKind::in, "", example},
#define WORD(word, example) {ShapeKind::NAME, ShapeKind::any, ShapeKind::any, #word, example},
#include "compiler/syntax/lines.def"
#undef WORD
#undef LINE
};

bool begins_statement(TokenKind kind) {
  return is_one_of(kind, {Kinds::DO, Kinds::ELSE, Kinds::NEWLINE});
}

// Although the line end before it does not count.
bool begins_in_line(TokenKind kind) {
  return is_one_of(kind, {Kinds::ELSE_IF, Kinds::OPTION, Kinds::RESUME});
}

// A line in a piece of the program, and its contents.
class WrittenLine {
public:
  WrittenLine(Tokens piece, std::size_t at, const SourceFile& source)
      : piece_(std::move(piece)), source_(source) {
    std::vector<std::uint32_t> order;
    significant(piece_, order);  // the line end after a WHEN does not count
    for (const std::uint32_t place : order) {
      const TokenKind kind = piece_[place].kind;
      if (place >= at && is_one_of(kind, {Kinds::NEWLINE, Kinds::DO, Kinds::ELSE})) break;
      if (begins_in_line(kind)) line_.clear();
      line_.push_back(place);
      if (place < at && begins_statement(kind)) line_.clear();
    }
    starts_at_ = line_.empty() || line_.front() >= at;
  }

  [[nodiscard]] bool starts_at() const { return starts_at_; }
  [[nodiscard]] TokenKind kind(std::size_t number) const {
    return number < line_.size() ? piece_[line_[number]].kind : ShapeKind::any;
  }
  [[nodiscard]] std::string_view text(std::size_t number) const {
    return source_.text(piece_[line_[number]].span);
  }
  [[nodiscard]] bool has(TokenKind wanted) const {
    return std::ranges::any_of(line_, [&](std::size_t at) { return piece_[at].kind == wanted; });
  }
  [[nodiscard]] TokenKind item() const { return piece_.front().kind; }

  // The first result of `of` that is not empty, over the names in the line; in a CHECK, also over those in its first line.
  // Otherwise the result for an empty name.
  template <typename Function>
  [[nodiscard]] std::string of_names(Function of) const {
    std::vector<std::size_t> places = line_;
    for (std::size_t at = 0; item() == Kinds::CHECK && !ends_line(at); ++at)
      places.push_back(at);
    for (const std::size_t at : places) {
      const std::string_view name = source_.text(piece_[at].span);
      if (piece_[at].kind != Kinds::NAME || name.empty()) continue;
      if (std::string found = of(name); !found.empty()) return found;
    }
    return of(std::string_view());
  }

  // The columns in the first line of the MOTION.
  [[nodiscard]] std::size_t columns() const {
    const auto end = std::ranges::find(piece_, Kinds::NEWLINE, &Token::kind);
    return 1 + static_cast<std::size_t>(std::count_if(
                   piece_.begin(), end, [](const Token& t) { return t.kind == Kinds::COMMA; }));
  }

private:
  [[nodiscard]] bool ends_line(std::size_t at) const {
    return at >= piece_.size() || piece_[at].kind == Kinds::NEWLINE;
  }

  Tokens piece_;
  const SourceFile& source_;
  std::vector<std::size_t> line_;  // indices into the piece
  bool starts_at_ = false;
};

// Fills the braces of an example.
class Filling {
public:
  Filling(const WrittenLine& line, const OwnNames& own, const Vocabulary* robot)
      : line_(line), own_(own), robot_(robot) {}

  [[nodiscard]] std::string fill(std::string_view example) const {
    std::string text;
    for (;;) {
      const std::size_t open = example.find('{');
      text += example.substr(0, open);
      if (open == std::string_view::npos) return text;
      const std::size_t close = example.find('}', open);
      text += say(example.substr(open + 1, close - open - 1));
      example.remove_prefix(close + 1);
    }
  }

  // A command with this verb if the robot has it; otherwise with another verb.
  [[nodiscard]] std::string command(std::string_view verb) const {
    const auto of_robot = [&](std::string_view named) {
      return line_.of_names([&](std::string_view name) {
        return robot_ == nullptr ? "" : robot_->command(named, name, line_.has(Kinds::TO));
      });
    };
    std::string text = of_robot(verb);
    if (text.empty() && !verb.empty()) text = of_robot("");
    if (!text.empty()) return text;
    return line_.has(Kinds::TO) ? "MOVE left_arm TO 60deg SLOWLY" : "MOVE left_arm UP SLOWLY";
  }

private:
  using Part = Vocabulary::Part;

  struct Gap {
    std::string_view name;
    std::string (Filling::*say)() const;
  };

  // The name that the line declares; it may be its first word, in a CHECK.
  [[nodiscard]] std::string own_name(std::string_view otherwise) const {
    const std::size_t place = line_.kind(0) == Kinds::NAME ? 0 : 1;
    return std::string(line_.kind(place) == Kinds::NAME ? line_.text(place) : otherwise);
  }

  [[nodiscard]] std::string say(std::string_view name) const {
    constexpr std::string_view own = "own ";
    if (name.starts_with(own)) return own_name(name.substr(own.size()));
    static constexpr std::array gaps = {
        Gap{"condition", &Filling::condition}, Gap{"command", &Filling::any_command},
        Gap{"reading", &Filling::reading},     Gap{"channel", &Filling::channel},
        Gap{"threshold", &Filling::threshold}, Gap{"actuator", &Filling::actuator},
        Gap{"speed_limit", &Filling::speed},   Gap{"followed", &Filling::followed},
        Gap{"setting", &Filling::setting},     Gap{"number", &Filling::number},
        Gap{"step", &Filling::step},           Gap{"timer", &Filling::timer},
        Gap{"motion", &Filling::motion},       Gap{"columns", &Filling::columns},
    };
    const auto* const gap = std::ranges::find(gaps, name, &Gap::name);
    return gap == gaps.end() ? std::string() : (this->*gap->say)();
  }

  [[nodiscard]] std::string of_robot(Part part, std::string_view otherwise) const {
    std::string text = line_.of_names(
        [&](std::string_view name) { return robot_ == nullptr ? "" : robot_->part(part, name); });
    return text.empty() ? std::string(otherwise) : text;
  }

  // A name that the program declares: the one used in the line, or else the first.
  [[nodiscard]] const OwnNames::Name* own(std::initializer_list<TokenKind> declared) const {
    const OwnNames::Name* found = nullptr;
    (void)line_.of_names([&](std::string_view name) {
      found = own_.find(declared, name);
      return std::string(found == nullptr ? "" : "found");
    });
    return found;
  }

  // A condition on a variable or a state if the line names one, otherwise on a reading of the robot.
  [[nodiscard]] std::string condition() const {
    std::string text = line_.of_names([&](std::string_view name) {
      const OwnNames::Name* const own =
          name.empty() ? nullptr : own_.find({Kinds::REMEMBER, Kinds::FEELING, Kinds::STATE}, name);
      if (own == nullptr) return robot_ == nullptr ? "" : robot_->part(Part::condition, name);
      const bool state = own->declared == Kinds::STATE;
      return std::string(own->name) + (state ? " IS " : " > 3") + std::string(own->more);
    });
    return text.empty() ? "touch LEVEL > 3" : text;
  }

  [[nodiscard]] std::string setting() const {
    const OwnNames::Name* const name = own({Kinds::REMEMBER, Kinds::STATE});
    if (name == nullptr) return "visits TO 3";
    const bool state = name->declared == Kinds::STATE;
    return std::string(name->name) + " TO " + (state ? "" : "3") + std::string(name->more);
  }

  [[nodiscard]] const OwnNames::Name* raised() const {
    return own({Kinds::REMEMBER, Kinds::FEELING});
  }
  [[nodiscard]] std::string number() const {
    return std::string(raised() == nullptr ? "visits" : raised()->name);
  }
  [[nodiscard]] std::string step() const {
    return "1" + std::string(raised() == nullptr ? "" : raised()->more);
  }
  [[nodiscard]] std::string timer() const {
    return std::string(own({Kinds::TIMER}) == nullptr ? "idle" : own({Kinds::TIMER})->name);
  }
  [[nodiscard]] std::string motion() const {
    return std::string(own({Kinds::MOTION}) == nullptr ? "wave" : own({Kinds::MOTION})->name);
  }
  [[nodiscard]] std::string columns() const {
    std::string text = "10deg";
    for (std::size_t i = 1; i < line_.columns(); ++i)
      text += " 10deg";
    return text;
  }

  [[nodiscard]] std::string any_command() const { return command(""); }
  [[nodiscard]] std::string reading() const { return of_robot(Part::reading, "touch LEVEL = 3"); }
  [[nodiscard]] std::string channel() const { return of_robot(Part::channel, "touch LEVEL"); }
  [[nodiscard]] std::string threshold() const { return of_robot(Part::threshold, "3"); }
  [[nodiscard]] std::string actuator() const { return of_robot(Part::actuator, "left_arm"); }
  [[nodiscard]] std::string speed() const {
    return of_robot(Part::speed_limit, "left_arm SPEED TO 60deg/s");
  }
  [[nodiscard]] std::string followed() const { return of_robot(Part::followed, "head TO 30deg"); }

  const WrittenLine& line_;
  const OwnNames& own_;
  const Vocabulary* robot_;
};

bool fits(const LineShape& line, const WrittenLine& written) {
  const auto is = [](TokenKind wanted, TokenKind kind) {
    return wanted == ShapeKind::any || wanted == kind;
  };
  return line.first == written.kind(0) && is(line.next, written.kind(1)) &&
         is(line.in, written.item()) &&
         (line.word.empty() || ascii::same(line.word, written.text(0)));
}

std::string like_this(const std::string& what, const std::string& example) {
  return what + " is written like this: `" + example + "`";
}

}  // namespace

OwnNames::OwnNames(const Tokens& program, const SourceFile& source) {
  constexpr std::size_t most = 256;  // enough for any program; the text may come from outside
  const auto text = [&](std::size_t at) { return source.text(program[at].span); };
  for (std::size_t at = 0; at + 3 < program.size() && names.size() < most; ++at) {
    if (program[at + 1].kind != Kinds::NAME) continue;
    switch (program[at].kind) {
      case Kinds::REMEMBER:
      case Kinds::FEELING:
        if (program[at + 3].kind == Kinds::QUANTITY)
          names.push_back({program[at].kind, text(at + 1), written_unit(text(at + 3))});
        break;
      case Kinds::STATE:
        if (program[at + 3].kind == Kinds::NAME)
          names.push_back({Kinds::STATE, text(at + 1), text(at + 3)});
        break;
      case Kinds::TIMER:
      case Kinds::MOTION:
        names.push_back({program[at].kind, text(at + 1), ""});
        break;
      default:
        break;
    }
  }
}

const OwnNames::Name* OwnNames::find(std::initializer_list<TokenKind> declared,
                                     std::string_view name) const {
  const auto found = std::ranges::find_if(names, [&](const Name& one) {
    return is_one_of(one.declared, declared) && (name.empty() || ascii::same(one.name, name));
  });
  return found == names.end() ? nullptr : &*found;
}

std::string Examples::written_like(const Tokens& piece, std::size_t at) const {
  const WrittenLine line(piece, at, source_);
  if (line.starts_at() || line.text(0).empty()) return {};  // empty: a repair put it there
  const Filling filling(line, own_, robot_);
  const auto* const found =
      std::ranges::find_if(kShapes, [&](const LineShape& one) { return fits(one, line); });
  if (found != std::end(kShapes)) {
    const bool word = found->first != Kinds::NAME || !found->word.empty();
    const std::string what = word ? "`" + std::string(line.text(0)) + "`" : "a line of a CHECK";
    return like_this(what, filling.fill(found->example));
  }
  if (line.kind(0) != Kinds::NAME) return {};
  const std::string verb(line.text(0));
  const std::string example = filling.command(verb);
  const bool same = ascii::same(example.substr(0, example.find(' ')), verb);
  return like_this(same ? "`" + verb + "`" : "a command", example);
}

std::string Examples::command(std::string_view actuator, bool places) const {
  std::string text;
  if (robot_ != nullptr) text = robot_->command("", actuator, places);
  if (robot_ != nullptr && text.empty()) text = robot_->command("", "", places);
  return text.empty() ? "MOVE left_arm UP SLOWLY" : text;
}

std::string Examples::condition(const std::vector<std::string_view>& words) const {
  using Part = Vocabulary::Part;
  const auto sensor = std::ranges::find_if(words, [&](auto word) { return is_sensor(word); });
  const std::string text =
      robot_ == nullptr ? "" : robot_->part(Part::condition, sensor == words.end() ? "" : *sensor);
  return text.empty() ? "touch LEVEL > 3" : text;
}

bool Examples::is_verb(std::string_view word) const {
  return robot_ != nullptr && !word.empty() && !robot_->command(word, "", false).empty();
}

bool Examples::is_actuator(std::string_view word) const {
  return robot_ != nullptr && !word.empty() && !robot_->command("", word, false).empty();
}

bool Examples::is_sensor(std::string_view word) const {
  return robot_ != nullptr && !word.empty() &&
         !robot_->part(Vocabulary::Part::condition, word).empty();
}

}  // namespace robosync::compiler
