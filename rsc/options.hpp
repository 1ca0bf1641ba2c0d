// The options of a verb. The verb declares them (verbs/NAME.cpp); cli.cpp, the only file that uses the
// command-line library, fills in the declared variables, then calls the verb.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace robosync::tool {

class Options {
public:
  enum class Need { optional, required };
  // Takes a word of the command line. Throws std::invalid_argument if the word is not valid.
  using Take = std::function<void(const std::string&)>;

  explicit Options(CLI::App& app) : app_(app) {}

  // Positional: FILE, and FILE... for any number.
  void argument(const std::string& name, std::string& value, const std::string& description,
                Need need);
  void arguments(const std::string& name, std::vector<std::string>& values,
                 const std::string& description, Need need);

  // Named: `--name TEXT`, where TEXT is what help shows for the value. Several names: "-o,--output".
  void option(const std::string& names, const std::string& text, std::string& value,
              const std::string& description, Need need = Need::optional);
  void option(const std::string& names, const std::string& text, const Take& take,
              const std::string& description);
  // Any number of times; `take` gets each value.
  void options(const std::string& names, const std::string& text, const Take& take,
               const std::string& description, Need need = Need::optional);
  void flag(const std::string& name, bool& value, const std::string& description);
  // One of `words`, which help lists; `take` gets its index.
  void choice(const std::string& name, const std::vector<std::string>& words,
              const std::function<void(std::size_t)>& take, const std::string& description);

  // What the verb does once its options are read. It throws Failure if it cannot do its work.
  void runs(std::function<void()> verb);

private:
  CLI::App& app_;
};

}  // namespace robosync::tool
