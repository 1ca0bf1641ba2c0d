// rsc/files.hpp: what is read is the whole file, whatever its size and kind.
#include "rsc/files.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;

// A path that nothing has, gone again at the end.
struct Scratch {
  fs::path path = fs::temp_directory_path() / ("rsc_files_" + std::to_string(getpid()));
  ~Scratch() { fs::remove(path); }
  void write(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }
};

TEST_CASE("files of all sizes are read whole") {
  const Scratch scratch;
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 300'000U, 16U * 1024 * 1024}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; i += 97)
      text[i] = static_cast<char>(i);
    scratch.write(text);
    CHECK(read_text(scratch.path) == text);
  }
}

TEST_CASE("a file of more than 16 MiB is refused") {
  const Scratch scratch;
  scratch.write(std::string(16 * 1024 * 1024 + 1, 'x'));
  CHECK_THROWS_AS(read_text(scratch.path), Failure);
}

TEST_CASE("a pipe, whose size nobody knows, is read to its end") {
  const Scratch scratch;
  REQUIRE(mkfifo(scratch.path.c_str(), 0600) == 0);
  const std::string text(200'000, 'p');
  std::thread writer([&] { scratch.write(text); });
  CHECK(read_text(scratch.path) == text);
  writer.join();
}

TEST_CASE("reading a file takes the memory that the file needs") {
  const Scratch scratch;
  scratch.write("small");
  CHECK(read_text(scratch.path).capacity() < 1024);
}

}  // namespace
}  // namespace robosync::tool
