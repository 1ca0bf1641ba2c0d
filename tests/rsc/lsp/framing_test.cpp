// Messages in a stream of bytes, whole, in pieces, and damaged.
#include "rsc/lsp/framing.hpp"

#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace robosync::tool;
using What = lsp::Frame::What;

namespace {

// Every message of a stream that comes in pieces of this size.
std::vector<std::string> read_all(const std::string& stream, std::size_t piece) {
  lsp::FrameReader reader;
  std::vector<std::string> messages;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    reader.feed(std::string_view(stream).substr(at, piece));
    for (lsp::Frame frame = reader.next(); frame.what == What::message; frame = reader.next())
      messages.push_back(frame.body);
  }
  return messages;
}

What first(const std::string& stream) {
  lsp::FrameReader reader;
  reader.feed(stream);
  return reader.next().what;
}

}  // namespace

TEST_CASE("messages are the same, whatever pieces they come in") {
  const std::vector<std::string> bodies = {"{}", "", "{\"a\": \"\r\n\r\n\"}",
                                           "Content-Length: 5\r\n\r\n"};
  std::string stream;
  for (const std::string& body : bodies)
    stream += lsp::framed(body);
  for (std::size_t piece = 1; piece <= stream.size(); ++piece)
    REQUIRE(read_all(stream, piece) == bodies);
}

TEST_CASE("a header may say more than the length, in any case of its letters") {
  CHECK(read_all("content-length:2\r\nContent-Type: a/b; charset=utf-8\r\n\r\n{}", 7) ==
        std::vector<std::string>{"{}"});
}

TEST_CASE("a header that does not say the length of a message ends the stream") {
  CHECK(first("\r\n\r\n{}") == What::broken);
  CHECK(first("Content-Length: -1\r\n\r\n") == What::broken);
  CHECK(first("Content-Length: 1x\r\n\r\n") == What::broken);
  CHECK(first("Content-Length: \r\n\r\n") == What::broken);
  CHECK(first("Content-Length: 99999999999999999999999\r\n\r\n") == What::broken);
  CHECK(first("Content-Length: 1\r\nContent-Length: 2\r\n\r\n") == What::broken);
  CHECK(first("GET / HTTP/1.1\r\n\r\n") == What::broken);
  CHECK(first(std::string(lsp::kLargestHeader, 'a')) == What::broken);
  CHECK(first("Content-Length: 1\r\n") == What::incomplete);
}

TEST_CASE("a message that is too large is left out, and the next one is read") {
  for (const std::size_t piece : {1U, 3U, 50U, 4000U}) {
    lsp::FrameReader reader(10);
    const std::string stream = lsp::framed(std::string(1000, 'x')) + lsp::framed("{}");
    unsigned too_large = 0;
    std::vector<std::string> messages;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      reader.feed(std::string_view(stream).substr(at, piece));
      for (lsp::Frame frame = reader.next(); frame.what != What::incomplete;
           frame = reader.next()) {
        REQUIRE(frame.what != What::broken);
        if (frame.what == What::too_large)
          ++too_large;
        else
          messages.push_back(frame.body);
      }
    }
    CHECK(too_large == 1);
    CHECK(messages == std::vector<std::string>{"{}"});
  }
}

TEST_CASE("any bytes are read to an end") {
  std::mt19937 random(7);
  const std::string pieces[] = {"Content-Length: ", "\r\n\r\n", "\r\n", "7", "0", ":", "{}", "\xFF",
                                "Content-Type: x"};
  for (int round = 0; round < 20'000; ++round) {
    lsp::FrameReader reader(100);
    for (int i = 0; i < 8; ++i) {
      reader.feed(random() % 4 == 0 ? std::string(random() % 5, static_cast<char>(random()))
                                    : pieces[random() % std::size(pieces)]);
      unsigned read = 0;
      for (lsp::Frame frame = reader.next();
           frame.what == What::message || frame.what == What::too_large; frame = reader.next())
        REQUIRE(++read < 100);
    }
  }
}
