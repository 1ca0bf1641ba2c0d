// Numbers in words: `THREE TIMES WITHIN 2s`, `TWICE WITHIN 2s`, `FOR two seconds`. RSL has digits.
#pragma once

#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// 3 for `three`, in any case; 0: it is none from 1 to 10.
[[nodiscard]] unsigned number_in_words(std::string_view word);

// Reports each that cannot be a name where it stands, and makes it a number. `robot` may be null.
void mend_number_words(Tokens& tokens, const SourceFile& source, const Vocabulary* robot,
                       Diagnostics& diagnostics);

}  // namespace robosync::compiler
