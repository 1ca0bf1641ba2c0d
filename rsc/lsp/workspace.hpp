// The texts that an editor has open, and what the compiler says about the programs among them. What is not open is read from
// the disk.
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
  bool whole = true;  // the text is all of the new one
  Place begin{}, end{};
  std::string text{};
};

// A program as it was last compiled.
class Checked {
public:
  // `trouble`: why it could not be compiled; empty: it was.
  explicit Checked(compiler::Result result, std::string trouble = {})
      : result_(std::move(result)), trouble_(std::move(trouble)) {}

  [[nodiscard]] const compiler::Result& result() const { return result_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] compiler::query::Project project() const;
  // Made when they are asked for first.
  [[nodiscard]] const compiler::query::Symbols& symbols() const;
  // The file that was read from there; nothing when none was.
  [[nodiscard]] std::optional<compiler::FileId> file(const std::filesystem::path& path) const;

private:
  compiler::Result result_;
  std::string trouble_;
  mutable std::optional<compiler::query::Symbols> symbols_;
};

class Workspace : public Texts {
public:
  void set_encoding(Encoding encoding) { encoding_ = encoding; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }

  void open(const std::string& uri, std::int64_t version, std::string text);
  // False when it is not open.
  [[nodiscard]] bool change(const std::string& uri, std::int64_t version,
                            const std::vector<Change>& changes);
  [[nodiscard]] bool close(const std::string& uri);
  // Something on the disk is another now.
  void forget() { checked_.clear(); }

  [[nodiscard]] const Document* find(const std::string& uri) const;
  [[nodiscard]] const Document* find(const std::filesystem::path& path) const;
  [[nodiscard]] const std::map<std::string, Document>& documents() const { return documents_; }

  // Programs to look at: those that are open, and those on the disk that an open robot.json belongs to.
  [[nodiscard]] std::set<std::string> programs() const;
  // Compiles when something that it is made of has changed.
  [[nodiscard]] const Checked& checked(const std::string& program);
  // All of them, but for modules that another one of them uses.
  [[nodiscard]] std::vector<const Checked*> checked_programs();
  // Those that `path` is a part of, the program of this name first.
  [[nodiscard]] std::vector<const Checked*> users_of(const std::filesystem::path& path);

  // Texts.
  [[nodiscard]] std::string read(const std::filesystem::path& path) const override;
  [[nodiscard]] bool has(const std::filesystem::path& path) const override;

private:
  void changed(const std::string& name);
  void add_users_of_configuration(const std::filesystem::path& path,
                                  std::set<std::string>& programs) const;

  Encoding encoding_ = Encoding::utf16;
  std::map<std::string, Document> documents_;  // by path, or by address where there is none
  std::map<std::string, std::unique_ptr<const Checked>> checked_;
};

// The name that a document has in the workspace: its path, or its address where it has none.
[[nodiscard]] std::string name_of(const std::string& uri);

}  // namespace robosync::tool::lsp
