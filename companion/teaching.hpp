// What `rsc teach` does: words are added to a file of words, listed and forgotten. The file is replaced as a whole, or not at all.
#pragma once

#include <string>
#include <vector>

#include "companion/words_file.hpp"
#include "companion/worker.hpp"

namespace robosync::companion {

// Throws Failure (asked_wrongly) when there is none, or it cannot be understood: as all of these.
[[nodiscard]] std::vector<TaughtWord> load_words(const std::string& file);

// --words FILE --teach WORD, of --recording FILE… or --source.
void teach(const Arguments& arguments);
void forget(const std::string& file, const std::string& name);
void list(const std::string& file);

}  // namespace robosync::companion
