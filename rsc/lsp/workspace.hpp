// The texts that an editor has open, and the compiler's results for the programs among them. Other files are read from disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/compiler.hpp"
#include "compiler/query/symbols.hpp"
#include "rsc/files.hpp"
#include "rsc/lsp/positions.hpp"

namespace robosync::tool::lsp {

struct Document {
  std::string uri;  // as the editor writes it
  std::int64_t version = 0;
  compiler::SourceFile source;
};

struct Change {
  bool whole = true;  // the text replaces the whole document
  Place begin{}, end{};
  std::string text{};
};

// A program's last compilation.
class Checked {
public:
  // `trouble`: why it could not be compiled; empty: it was compiled.
  explicit Checked(compiler::Result result, std::string trouble = {})
      : result_(std::move(result)), trouble_(std::move(trouble)) {}

  [[nodiscard]] const compiler::Result& result() const { return result_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] compiler::query::Project project() const;
  // Made on first use.
  [[nodiscard]] const compiler::query::Symbols& symbols() const;
  // The file of the compilation at this path; nothing if there is none.
  [[nodiscard]] std::optional<compiler::FileId> file(const std::filesystem::path& path) const;

private:
  compiler::Result result_;
  std::string trouble_;
  mutable std::optional<compiler::query::Symbols> symbols_;
};

// The most programs that are looked at for one robot.json.
inline constexpr std::size_t kMostPrograms = 32;

class Workspace : public Texts {
public:
  void set_encoding(Encoding encoding) { encoding_ = encoding; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }

  void open(const std::string& uri, std::int64_t version, std::string text);
  // False if it is not open.
  [[nodiscard]] bool change(const std::string& uri, std::int64_t version,
                            const std::vector<Change>& changes);
  [[nodiscard]] bool close(const std::string& uri);
  // Something on disk has changed.
  void forget() { checked_.clear(); }

  [[nodiscard]] const Document* find(const std::string& uri) const;
  [[nodiscard]] const Document* find(const std::filesystem::path& path) const;
  [[nodiscard]] const std::map<std::string, Document>& documents() const { return documents_; }

  // The programs to check: those that are open, and those on disk that use an open robot.json.
  [[nodiscard]] std::set<std::string> programs() const;
  // Compiles if one of its files has changed.
  [[nodiscard]] const Checked& checked(const std::string& program);
  // All programs, except modules that another one uses.
  [[nodiscard]] std::vector<const Checked*> checked_programs();
  // The programs on disk and in the editor that use a robot.json; itself if there is none. At most kMostPrograms on disk.
  [[nodiscard]] std::set<std::string> users_of_configuration(
      const std::filesystem::path& path) const;
  // The program as if some of its files had other texts, by their names.
  [[nodiscard]] Checked checked_with(const Checked& program,
                                     const std::map<std::string, std::string>& texts) const;
  // The programs that `path` is part of; `path` itself first, if it is a program.
  [[nodiscard]] std::vector<const Checked*> users_of(const std::filesystem::path& path);

  // Texts.
  [[nodiscard]] std::string read(const std::filesystem::path& path) const override;
  [[nodiscard]] bool has(const std::filesystem::path& path) const override;

private:
  void changed(const std::string& name);

  Encoding encoding_ = Encoding::utf16;
  std::map<std::string, Document> documents_;  // by path, or by URI if there is none
  std::map<std::string, std::unique_ptr<const Checked>> checked_;
};

// A document's name in the workspace: its path, or its URI if it has none.
[[nodiscard]] std::string name_of(const std::string& uri);

}  // namespace robosync::tool::lsp
