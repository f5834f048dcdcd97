// A file with given bytes that is gone when the test is over.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace gnomon::ar {

class TempFile {
 public:
  TempFile(std::string_view bytes, const std::string& extension) {
    static std::atomic<int> counter{0};
    path_ = std::filesystem::temp_directory_path() / ("gnomon_test_" + std::to_string(::getpid()) +
                                                      "_" + std::to_string(counter++) + extension);
    std::ofstream(path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  ~TempFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace gnomon::ar
