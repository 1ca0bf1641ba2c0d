# For the scripts that embed texts in the compiler and in the tool. They are packed, as plain text would take three times the room.
#   embed(PIECE TEXT)   adds TEXT, and sets PIECE to the EmbeddedText (compiler/source/embedded.hpp) that stands for it
#   pack(CODE)          sets CODE to the definition of all_texts(), to which these pieces refer
set(texts "")
function(embed piece text)
  string(LENGTH "${texts}" at)
  string(LENGTH "${text}" size)
  set(${piece} "{all_texts, ${at}, ${size}}" PARENT_SCOPE)
  set(texts "${texts}${text}" PARENT_SCOPE)
endfunction()

function(pack code)
  file(WRITE ${OUT}.txt "${texts}")
  execute_process(COMMAND gzip -9n INPUT_FILE ${OUT}.txt OUTPUT_FILE ${OUT}.gz COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUT}.gz bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(LENGTH "${texts}" size)
  set(${code} "constexpr unsigned char kPacked[] = {${bytes}};

const std::string& all_texts() {
  static const std::string texts = compiler::unpacked(kPacked, ${size});
  return texts;
}
" PARENT_SCOPE)
endfunction()
