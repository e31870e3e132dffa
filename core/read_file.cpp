#include "tenon/core/read_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "tenon/core/input_error.hpp"

namespace tenon {

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError({path, 0, 0}, "is a folder", "a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError({path, 0, 0}, std::string("cannot be read: ") + std::strerror(errno));
  std::string text;
  char block[1 << 16];
  for (std::size_t count; (count = std::fread(block, 1, sizeof block, file.get())) > 0;) text.append(block, count);
  if (std::ferror(file.get())) throw InputError({path, 0, 0}, "cannot be read: an error while reading");
  return text;
}

}  // namespace tenon
