// The tokens of RSL. re2c generates a scanner from this file that looks at each byte once;
// compiler/syntax/lexer_state.cpp handles the matches. The text is bytes: everything above ASCII is handled
// there, code point by code point.
#include "compiler/syntax/lexer_state.hpp"

namespace robosync::compiler {

bool LexerState::step() {
  const auto* const begin = reinterpret_cast<const unsigned char*>(text_.data());
  const unsigned char* const YYLIMIT = begin + text_.size();
  const unsigned char* YYCURSOR = begin + cursor_;
  const unsigned char* YYMARKER = nullptr;
  start_ = cursor_;
  const auto matched = [&] { cursor_ = static_cast<std::size_t>(YYCURSOR - begin); };

  /*!re2c
    re2c:define:YYCTYPE = "unsigned char";
    re2c:yyfill:enable = 0;
    re2c:eof = 0;
    re2c:indent:string = "  ";

    digit   = [0-9];
    high    = [\x80-\xff];
    word    = [A-Za-z_] [A-Za-z0-9_]* | high;  // word() adds the letters above ASCII
    decimal = digit+ ("." digit+)?;
    unit    = "%" | ([A-Za-z] | high)+ ("/" [A-Za-z]+)?;

    $                               { return false; }
    [ \t\v\f]+                      { matched(); return true; }
    "\n" | "\r\n" | "\r"            { matched(); token(Kinds::NEWLINE); return true; }
    [%#] [^\r\n]*                   { matched(); comment(); return true; }

    word                            { matched(); word(); return true; }
    decimal unit?                   { matched(); quantity(); return true; }
    digit+ [A-Za-z0-9_.]+           { matched(); bad_number(); return true; }
    decimal unit [A-Za-z0-9_.]+     { matched(); bad_number(); return true; }
    "." digit+ unit?                { matched(); bad_fraction(); return true; }
    ["] [^"\r\n]* ["]               { matched(); string(); return true; }
    ['] [^'\r\n]* [']               { matched(); string(); return true; }
    ["] [^"\r\n]* | ['] [^'\r\n]*   { matched(); open_string(); return true; }

    "<"                             { matched(); token(Kinds::LESS); return true; }
    ">"                             { matched(); token(Kinds::GREATER); return true; }
    "<="                            { matched(); token(Kinds::LESS_EQUAL); return true; }
    ">="                            { matched(); token(Kinds::GREATER_EQUAL); return true; }
    "=" | "=="                      { matched(); token(Kinds::EQUAL); return true; }
    "<>" | "!="                     { matched(); token(Kinds::NOT_EQUAL); return true; }
    "+"                             { matched(); token(Kinds::PLUS); return true; }
    "-"                             { matched(); token(Kinds::MINUS); return true; }
    "*"                             { matched(); token(Kinds::STAR); return true; }
    "/"                             { matched(); token(Kinds::SLASH); return true; }
    "("                             { matched(); token(Kinds::OPEN); return true; }
    ")"                             { matched(); token(Kinds::CLOSE); return true; }
    ","                             { matched(); token(Kinds::COMMA); return true; }
    ":"                             { matched(); colon(); return true; }

    "=<"                            { matched(); instead(Kinds::LESS_EQUAL, "<="); return true; }
    "=>"                            { matched(); instead(Kinds::GREATER_EQUAL, ">="); return true; }
    "=!"                            { matched(); instead(Kinds::NOT_EQUAL, "<>"); return true; }
    "=/=" | "~="                    { matched(); instead(Kinds::NOT_EQUAL, "<>"); return true; }
    "&&" | "&"                      { matched(); instead(Kinds::AND, "AND"); return true; }
    "||" | "|"                      { matched(); instead(Kinds::OR, "OR"); return true; }
    "!"                             { matched(); instead(Kinds::NOT, "NOT "); return true; }
    ":="                            { matched(); assignment(); return true; }
    ";"+                            { matched(); semicolon(); return true; }
    [{]                             { matched(); opening_brace(); return true; }
    [}]                             { matched(); closing_brace(); return true; }
    "//" [^\r\n]*                   { matched(); foreign_comment(); return true; }
    "--" [ \t]+ [A-Za-z] [^\r\n]*   { matched(); foreign_comment(); return true; }
    "/*"                            { matched(); long_comment(); return true; }
    *                               { matched(); other(); return true; }
  */
}

}  // namespace robosync::compiler
