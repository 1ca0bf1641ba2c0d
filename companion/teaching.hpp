// The work of `rsc teach`: adds words to a file of words, lists them and forgets them. The file is replaced as a whole or not at
// all.
#pragma once

#include <string>
#include <vector>

#include "companion/words_file.hpp"
#include "companion/worker.hpp"

namespace robosync::companion {

// Throws Failure (asked_wrongly) if the file is missing or cannot be parsed. So do the functions below.
[[nodiscard]] std::vector<TaughtWord> load_words(const std::string& file);

// --words FILE --teach WORD, with samples from --recording FILE… or --source.
void teach(const Arguments& arguments);
void forget(const std::string& file, const std::string& name);
void list(const std::string& file);

}  // namespace robosync::companion
