#include "ar/file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "ar/error.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

std::string one_line(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    if (control && (line.empty() || line.back() == ' ')) continue;
    line.push_back(control ? ' ' : c);
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::vector<std::uint8_t> read_file(const fs::path& path, std::uint64_t max_bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw InputError(fmt::format("{}: no such file", one_line(path.string())));
  if (!fs::is_regular_file(status))
    throw InputError(fmt::format("{}: not a regular file", one_line(path.string())));
  const std::uintmax_t size = fs::file_size(path, error);
  if (error)
    throw InputError(
        fmt::format("{}: cannot be read: {}", one_line(path.string()), one_line(error.message())));
  if (size > max_bytes)
    throw InputError(fmt::format("{}: {} bytes are more than the {} bytes accepted",
                                 one_line(path.string()), size, max_bytes));
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  if (!in || !in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    throw InputError(
        fmt::format("{}: cannot be read: {}", one_line(path.string()), std::strerror(errno)));
  return bytes;
}

PendingFile::PendingFile(fs::path target) : target_(std::move(target)) {
  // A counter and the process keep two writers of one target from sharing a temporary name.
  static std::atomic<unsigned> counter{0};
  std::error_code error;
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw InputError(fmt::format("{}: cannot be written: no folder {}", one_line(target_.string()),
                                 one_line(folder.string())));
  if (fs::is_directory(target_, error))
    throw InputError(
        fmt::format("{}: cannot be written: it is a folder", one_line(target_.string())));
  if (fs::exists(target_, error) && !fs::is_regular_file(target_, error))
    throw InputError(
        fmt::format("{}: cannot be written: it is no regular file", one_line(target_.string())));
  temporary_ = folder / fmt::format(".{}.{}-{}.partial{}", target_.stem().string(), ::getpid(),
                                    counter++, target_.extension().string());
  if (!std::ofstream(temporary_, std::ios::binary))
    throw InputError(
        fmt::format("{}: cannot be written: {}", one_line(target_.string()), std::strerror(errno)));
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void PendingFile::commit() {
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error)
    throw InputError(fmt::format("{}: cannot be written: {}", one_line(target_.string()),
                                 one_line(error.message())));
  committed_ = true;
}

void write_file(const fs::path& path, std::string_view contents) {
  PendingFile file(path);
  std::ofstream out(file.temporary(), std::ios::binary);
  out.write(contents.data(), static_cast<std::streamsize>(contents.size()));
  out.close();
  if (!out)
    throw InputError(
        fmt::format("{}: cannot be written: {}", one_line(path.string()), std::strerror(errno)));
  file.commit();
}

}  // namespace gnomon::ar
