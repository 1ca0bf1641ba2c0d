// See mutations.hpp.
#include "tests/compiler/syntax/mutations.hpp"

#include <cctype>
#include <utility>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/lexer.hpp"

namespace robosync::compiler::testing {

namespace {

std::size_t pick(std::size_t count, std::mt19937& random) {
  return random() % count;
}

std::vector<Span> words_of(const std::string& program) {
  Diagnostics ignored;
  std::vector<Span> words;
  for (const Token& token : lex(SourceFile("program", program), 0, ignored)) {
    if (token.kind != Kinds::NEWLINE && token.kind != Kinds::STRING) words.push_back(token.span);
  }
  return words;
}

std::string text_of(const std::string& program, Span word) {
  return program.substr(word.begin, word.end - word.begin);
}

std::string misspelt(std::string word, std::mt19937& random) {
  const std::size_t at = pick(word.size(), random);
  switch (pick(4, random)) {
    case 0:
      word.erase(at, word.size() > 1 ? 1 : 0);
      break;
    case 1:
      word.insert(at, 1, word[at]);
      break;
    case 2:
      if (at + 1 < word.size()) std::swap(word[at], word[at + 1]);
      break;
    default:
      word[at] = static_cast<char>('a' + pick(26, random));
      break;
  }
  return word;
}

std::string replaced(const std::string& program, Span word, const std::string& by) {
  return program.substr(0, word.begin) + by + program.substr(word.end);
}

}  // namespace

std::string name_of(Mutation mutation) {
  switch (mutation) {
    case Mutation::drop:
      return "drop";
    case Mutation::repeat:
      return "repeat";
    case Mutation::swap:
      return "swap";
    case Mutation::misspell:
      return "misspell";
    case Mutation::exchange:
      break;
  }
  return "exchange";
}

namespace {

std::string mutate_one_of(const std::string& program, const std::vector<Span>& words,
                          Mutation mutation, std::mt19937& random) {
  const std::size_t at = pick(words.size() - 1, random);
  const std::string word = text_of(program, words[at]);
  switch (mutation) {
    case Mutation::drop:
      return replaced(program, words[at], "");
    case Mutation::repeat:
      return replaced(program, words[at], word + " " + word);
    case Mutation::swap: {
      const std::string next = text_of(program, words[at + 1]);
      return replaced(replaced(program, words[at + 1], word), words[at], next);
    }
    case Mutation::misspell:
      if (word.front() == '"' && word.size() > 2)
        return replaced(program, words[at],
                        '"' + misspelt(word.substr(1, word.size() - 2), random) + '"');
      return replaced(program, words[at], misspelt(word, random));
    case Mutation::exchange:
      break;
  }
  return replaced(program, words[at], text_of(program, words[pick(words.size(), random)]));
}

bool is_json_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
}

std::vector<Span> words_of_json(const std::string& text) {
  std::vector<Span> words;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (text[at] == '"') {
      end = text.find('"', end) + 1;
    } else if (is_json_word(text[at])) {
      while (is_json_word(text[end]))
        ++end;
    }
    if (std::isspace(static_cast<unsigned char>(text[at])) == 0)
      words.push_back({0, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(end)});
    at = end;
  }
  return words;
}

}  // namespace

std::string mutate(const std::string& program, Mutation mutation, std::mt19937& random) {
  return mutate_one_of(program, words_of(program), mutation, random);
}

std::string mutate_json(const std::string& text, Mutation mutation, std::mt19937& random) {
  return mutate_one_of(text, words_of_json(text), mutation, random);
}

}  // namespace robosync::compiler::testing
