// What a verb's command line may say. A verb declares it (verbs/NAME.cpp); cli.cpp, the only file that knows
// the library that reads command lines, fills in what the declarations refer to, then calls the verb.
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
  // What is done with a word of the command line. Throws std::invalid_argument when it cannot be.
  using Take = std::function<void(const std::string&)>;

  explicit Options(CLI::App& app) : app_(app) {}

  // By place: FILE, and FILE... for as many as there are.
  void argument(const std::string& name, std::string& value, const std::string& description,
                Need need);
  void arguments(const std::string& name, std::vector<std::string>& values,
                 const std::string& description, Need need);

  // By name: `--name TEXT`, where TEXT is what help shows for the value. Several names: "-o,--output".
  void option(const std::string& names, const std::string& text, std::string& value,
              const std::string& description, Need need = Need::optional);
  void option(const std::string& names, const std::string& text, const Take& take,
              const std::string& description);
  // As often as one likes; `take` is given each.
  void options(const std::string& names, const std::string& text, const Take& take,
               const std::string& description, Need need = Need::optional);
  void flag(const std::string& name, bool& value, const std::string& description);
  // One of `words`, which help shows; `take` is given its index.
  void choice(const std::string& name, const std::vector<std::string>& words,
              const std::function<void(std::size_t)>& take, const std::string& description);

  // What the verb does, once its options are read. Throws Failure when it cannot do its work.
  void runs(std::function<void()> verb);

private:
  CLI::App& app_;
};

}  // namespace robosync::tool
