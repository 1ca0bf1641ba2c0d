# The code that verifies signatures: libsodium on the host; on the board the few files of TinySSH that implement Ed25519, which
# scripts/signatures gets from Debian's source package.
if(NOT CMAKE_CROSSCOMPILING)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET GLOBAL libsodium)
  target_sources(robosync_runtime PRIVATE ${CMAKE_CURRENT_LIST_DIR}/signatures_sodium.cpp)
  list(APPEND runtime_libraries PkgConfig::SODIUM)
  return()
endif()

set(tinyssh ${PROJECT_SOURCE_DIR}/build/tinyssh/crypto)
if(NOT EXISTS ${tinyssh}/crypto_sign_ed25519.c)
  message(FATAL_ERROR
    "The firmware verifies signatures with code of Debian's source package tinyssh, which is not in build/tinyssh: "
    "run scripts/signatures, which gets it (other scripts do by themselves), or build a firmware that cannot be paired with an "
    "owner: -D ROBOSYNC_AUTHENTICATION=OFF")
endif()
add_library(robosync_ed25519 STATIC)
foreach(part crypto_sign_ed25519 crypto_hash_sha512 fe fe25519 ge25519 sc25519 crypto_verify_32 verify uint32_pack uint32_unpack)
  target_sources(robosync_ed25519 PRIVATE ${tinyssh}/${part}.c)
endforeach()
target_include_directories(robosync_ed25519 SYSTEM PUBLIC ${tinyssh})
target_compile_options(robosync_ed25519 PRIVATE -w -flto -ffat-lto-objects)
target_sources(robosync_runtime PRIVATE ${CMAKE_CURRENT_LIST_DIR}/signatures_tinyssh.cpp)
list(APPEND runtime_libraries robosync_ed25519)
