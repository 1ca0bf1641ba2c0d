// See owner_key.hpp. The file has a line of text, so that a person who finds it knows what it is, and a line of 64
// hexadecimal digits, the seed of the key.
#include "rsc/device/owner_key.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rsc/failure.hpp"
#include "rsc/file_kind.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;
constexpr std::size_t kLength = kKeyWords.size() + kDigits + 1;

[[noreturn]] void fail(const fs::path& file, const std::string& why) {
  throw Failure(Exit::outside, file.string() + ": " + why);
}

void start_sodium() {
  if (sodium_init() < 0) throw Failure(Exit::outside, "libsodium does not work here");
}

class File {
public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int get() const { return descriptor_; }

private:
  int descriptor_;
};

// Secret bytes, wiped after use.
template <typename Element, std::size_t kCount>
struct Wiped {
  Wiped() = default;
  ~Wiped() { sodium_memzero(bytes.data(), bytes.size()); }
  Wiped(const Wiped&) = delete;
  Wiped& operator=(const Wiped&) = delete;
  std::array<Element, kCount> bytes{};
};
using Text = Wiped<char, kLength + 1>;  // of the file, and one more to detect a longer file
using Seed = Wiped<unsigned char, crypto_sign_SEEDBYTES>;

void make_folder(const fs::path& folder) {
  if (folder.empty() || fs::exists(folder)) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, fs::perms::owner_all, error);
  if (error) fail(folder, error.message());
}

}  // namespace

fs::path default_key_file() {
  const char* const settings = std::getenv("XDG_CONFIG_HOME");
  if (settings != nullptr && fs::path(settings).is_absolute())
    return fs::path(settings) / "robosync" / "key";
  const char* const home = std::getenv("HOME");
  if (home == nullptr || *home == '\0')
    throw Failure(
        Exit::outside,
        "neither XDG_CONFIG_HOME nor HOME says where your key is: name it with --key FILE");
  return fs::path(home) / ".config" / "robosync" / "key";
}

fs::path key_file(const std::string& named) {
  return named.empty() ? default_key_file() : fs::path(named);
}

std::string id_of(const link::PublicKey& key) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), key.data(), key.size());
  std::string text;
  for (std::size_t i = 0; i < 8; ++i)
    text += fmt::format("{}{:02x}", i % 2 == 0 && i != 0 ? "-" : "", hash[i]);
  return text;
}

OwnerKey::OwnerKey(std::span<const unsigned char, kSeed> seed) {
  static_assert(crypto_sign_SEEDBYTES == kSeed && crypto_sign_SECRETKEYBYTES == 64);
  crypto_sign_seed_keypair(public_.data(), secret_.data(), seed.data());
}

OwnerKey::~OwnerKey() {
  sodium_memzero(secret_.data(), secret_.size());
}

std::unique_ptr<const OwnerKey> OwnerKey::make(const fs::path& file) {
  start_sodium();
  make_folder(file.parent_path());
  const File out(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (out.get() < 0 && errno == EEXIST)
    fail(file,
         "the file already exists, and a lost key locks its owner out of robots: move it away "
         "first, or name another with --key FILE");
  if (out.get() < 0) fail(file, std::strerror(errno));
  Seed seed;
  randombytes_buf(seed.bytes.data(), seed.bytes.size());
  Text text;
  char* const digits = std::copy(kKeyWords.begin(), kKeyWords.end(), text.bytes.data());
  sodium_bin2hex(digits, kDigits + 1, seed.bytes.data(), seed.bytes.size());
  digits[kDigits] = '\n';
  const bool written =
      write(out.get(), text.bytes.data(), kLength) == ssize_t{kLength} && fsync(out.get()) == 0;
  if (!written) fail(file, std::strerror(errno));
  return std::unique_ptr<const OwnerKey>(new OwnerKey(seed.bytes));
}

std::unique_ptr<const OwnerKey> OwnerKey::read(const fs::path& file) {
  start_sodium();
  const File in(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (in.get() < 0 && errno == ENOENT)
    fail(file, "there is no key: make one with rsc keygen, or name yours with --key FILE");
  if (in.get() < 0) fail(file, std::strerror(errno));
  struct stat about {};
  if (fstat(in.get(), &about) != 0) fail(file, std::strerror(errno));
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    fail(file, fmt::format("others may read or change this key: chmod 600 {}", file.string()));
  Text text;
  const ssize_t count = ::read(in.get(), text.bytes.data(), text.bytes.size());
  Seed seed;
  std::size_t bytes = 0;
  const bool good =
      count == ssize_t{kLength} &&
      std::string_view(text.bytes.data(), kKeyWords.size()) == kKeyWords &&
      sodium_hex2bin(seed.bytes.data(), seed.bytes.size(), text.bytes.data() + kKeyWords.size(),
                     kDigits, nullptr, &bytes, nullptr) == 0 &&
      bytes == seed.bytes.size();
  if (!good) fail(file, "this is not a key from rsc keygen");
  return std::unique_ptr<const OwnerKey>(new OwnerKey(seed.bytes));
}

link::Signature OwnerKey::sign(std::span<const std::byte> text) const {
  link::Signature signature{};
  crypto_sign_detached(signature.data(), nullptr,
                       reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                       secret_.data());
  return signature;
}

}  // namespace robosync::tool
