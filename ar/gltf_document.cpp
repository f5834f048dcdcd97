#include "ar/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <nlohmann/json.hpp>
#include <span>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::ar::gltf {

namespace fs = std::filesystem;
using nlohmann::json;

void fail(const fs::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: {}", one_line(path.string()), one_line(what)));
}

namespace {

std::uint32_t little_endian(std::span<const std::uint8_t> b) {
  return std::uint32_t{b[3]} << 24 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[1]} << 8 | b[0];
}

bool is_glb(std::span<const std::uint8_t> bytes) {
  static constexpr std::array<std::uint8_t, 4> kMagic{'g', 'l', 'T', 'F'};
  return bytes.size() >= 4 && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

/// The JSON text: the first chunk of a .glb, or the whole file.
std::string_view json_text(const fs::path& path, std::span<const std::uint8_t> bytes) {
  std::span<const std::uint8_t> text = bytes;
  if (is_glb(bytes)) {
    if (bytes.size() < 20)
      fail(path, fmt::format("truncated: {} bytes are no .glb file", bytes.size()));
    const std::uint32_t version = little_endian(bytes.subspan(4, 4));
    const std::uint32_t length = little_endian(bytes.subspan(8, 4));
    const std::uint32_t chunk = little_endian(bytes.subspan(12, 4));
    if (version != 2) fail(path, fmt::format(".glb version {}; 2 is read", version));
    if (length > bytes.size())
      fail(path, fmt::format("truncated: {} of {} bytes", bytes.size(), length));
    if (chunk > bytes.size() - 20)
      fail(path, fmt::format("truncated: the JSON chunk has {} bytes", chunk));
    text = bytes.subspan(20, chunk);
  }
  if (text.size() > kMaxJsonBytes)
    fail(path, fmt::format("{} bytes of JSON; at most {} are read", text.size(), kMaxJsonBytes));
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

/// Deeply nested values exhaust the stack of a recursive reader.
void check_depth(const fs::path& path, std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxDepth)
        fail(path, fmt::format("JSON nested deeper than {} at byte {}", kMaxDepth, i));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

/// Only files of the model's own folder (and what is embedded) are read.
void check_uri(const fs::path& path, const std::string& place, const std::string& uri) {
  if (uri.starts_with("data:")) return;
  const auto refuse = [&](std::string_view why) {
    fail(path, fmt::format("{}: uri \"{}\" {}", place, uri.substr(0, 100), why));
  };
  if (uri.empty()) refuse("is empty");
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      decoded += uri[i];
      continue;
    }
    const auto hex = [&](std::size_t at) {
      return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at]));
    };
    if (!hex(i + 1) || !hex(i + 2)) refuse("has a % without two hexadecimal digits");
    decoded += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
    i += 2;
  }
  for (const char c : decoded)
    if (static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == ':')
      refuse("is no relative path");
  if (decoded.front() == '/' || decoded.front() == '~') refuse("is no relative path");
  for (const fs::path& part : fs::path(decoded))
    if (part == "..") refuse("leaves the model's folder");
}

std::uint64_t unsigned_or(const json& object, const char* key, std::uint64_t absent) {
  const auto it = object.find(key);
  if (it == object.end()) return absent;
  return it->is_number_unsigned() ? it->get<std::uint64_t>() : ~std::uint64_t{0};
}

const json& array_of(const json& root, const char* name) {
  static const json kNone = json::array();
  const auto it = root.find(name);
  return it != root.end() && it->is_array() ? *it : kNone;
}

void check_buffers(const fs::path& path, const json& root) {
  std::uint64_t total = 0;
  const json& buffers = array_of(root, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string place = fmt::format("buffer {}", i);
    if (!buffers[i].is_object()) fail(path, place + ": not an object");
    const std::uint64_t length = unsigned_or(buffers[i], "byteLength", 0);
    if (length < 1 || length > kMaxBufferBytes || (total += length) > kMaxBufferBytes)
      fail(path, fmt::format("{}: byteLength is not within 1 to {} bytes", place, kMaxBufferBytes));
    if (const auto uri = buffers[i].find("uri"); uri != buffers[i].end()) {
      if (!uri->is_string()) fail(path, place + ": uri is no string");
      check_uri(path, place, uri->get<std::string>());
    }
  }
}

/// tinygltf forms a pointer into the buffer of a picture without a check.
void check_images(const fs::path& path, const json& root) {
  const json &images = array_of(root, "images"), &views = array_of(root, "bufferViews"),
             &buffers = array_of(root, "buffers");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string place = fmt::format("image {}", i);
    if (!images[i].is_object()) fail(path, place + ": not an object");
    if (const auto uri = images[i].find("uri"); uri != images[i].end()) {
      if (!uri->is_string()) fail(path, place + ": uri is no string");
      check_uri(path, place, uri->get<std::string>());
    }
    if (!images[i].contains("bufferView")) continue;
    const std::uint64_t view = unsigned_or(images[i], "bufferView", 0);
    if (view >= views.size() || !views[view].is_object())
      fail(path, fmt::format("{}: bufferView is not one of {}", place, views.size()));
    const std::uint64_t buffer = unsigned_or(views[view], "buffer", ~std::uint64_t{0});
    if (buffer >= buffers.size())
      fail(path, fmt::format("bufferView {}: buffer is not one of {}", view, buffers.size()));
    const std::uint64_t size = unsigned_or(buffers[buffer], "byteLength", 0);
    const std::uint64_t offset = unsigned_or(views[view], "byteOffset", 0);
    const std::uint64_t length = unsigned_or(views[view], "byteLength", 0);
    if (length < 1 || offset > size || length > size - offset)
      fail(path, fmt::format("bufferView {}: reaches behind the {} bytes of buffer {}", view, size,
                             buffer));
  }
}

void check_extensions(const fs::path& path, const json& root) {
  // Those that change how geometry is stored or placed would be read wrongly if they were ignored;
  // a material's or a light's extension only changes how it looks.
  for (const json& name : array_of(root, "extensionsRequired")) {
    const std::string text = name.is_string() ? name.get<std::string>() : name.dump();
    if (text != "KHR_mesh_quantization" && text != "KHR_lights_punctual" &&
        !text.starts_with("KHR_materials_"))
      fail(path, fmt::format("required extension \"{}\" is not read", text));
  }
}

/// Refuses what tinygltf would trip over.
json checked_json(const fs::path& path, std::string_view text) {
  check_depth(path, text);
  json root = json::parse(text);
  if (!root.is_object()) fail(path, "the JSON text is no object");
  const auto asset = root.find("asset");
  const bool has_version = asset != root.end() && asset->is_object() &&
                           asset->contains("version") && (*asset)["version"].is_string();
  const std::string version = has_version ? (*asset)["version"].get<std::string>() : "";
  if (!version.starts_with("2."))
    fail(path, fmt::format("asset.version is \"{}\"; glTF 2.0 is read", version));
  for (const auto& [key, value] : root.items())
    if (value.is_array() && value.size() > kMaxElements)
      fail(path,
           fmt::format("{} has {} elements; at most {} are read", key, value.size(), kMaxElements));
  check_extensions(path, root);
  check_buffers(path, root);
  check_images(path, root);
  return root;
}

/// Files beside the model, for tinygltf. Symbolic links that lead out of the folder are not
/// followed.
struct Folder {
  fs::path canonical;

  bool holds(const std::string& name) const {
    std::error_code error;
    const fs::path file = fs::canonical(name, error);
    if (error || !fs::is_regular_file(file, error)) return false;
    return std::mismatch(canonical.begin(), canonical.end(), file.begin(), file.end()).first ==
           canonical.end();
  }
};

tinygltf::FsCallbacks callbacks(Folder& folder) {
  tinygltf::FsCallbacks fs_callbacks{};
  fs_callbacks.FileExists = [](const std::string& name, void* user) {
    return static_cast<const Folder*>(user)->holds(name);
  };
  fs_callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  fs_callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error,
                                  const std::string& name, void* user) {
    if (!static_cast<const Folder*>(user)->holds(name)) return false;
    try {
      *out = read_file(name, kMaxFileBytes);
    } catch (const InputError& e) {
      if (error != nullptr) *error = e.what();
      return false;
    }
    return true;
  };
  fs_callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                   const std::vector<unsigned char>&, void*) { return false; };
  fs_callbacks.user_data = &folder;
  return fs_callbacks;
}

bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  image->as_is = true;
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

}  // namespace

Document load_document(const fs::path& path) {
  return load_document(path, read_file(path, kMaxFileBytes));
}

Document load_document(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const std::string_view text = json_text(path, bytes);
  Document document{path, {}, {}};
  std::string error, warning;
  bool loaded = false;
  try {
    const json root = checked_json(path, text);
    for (const json& node : array_of(root, "nodes"))
      document.node_extras.push_back(
          node.is_object() && node.contains("extras") ? node["extras"].dump() : "");
    Folder folder{fs::canonical(fs::absolute(path).parent_path())};
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    loader.SetFsCallbacks(callbacks(folder));
    loader.SetStoreOriginalJSONForExtrasAndExtensions(false);
    const auto size = static_cast<unsigned int>(bytes.size());
    loaded = is_glb(bytes)
                 ? loader.LoadBinaryFromMemory(&document.gltf, &error, &warning, bytes.data(), size,
                                               folder.canonical.string())
                 : loader.LoadASCIIFromString(&document.gltf, &error, &warning, text.data(), size,
                                              folder.canonical.string());
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail(path, "too large for this machine's memory");
  } catch (const std::exception& e) {
    fail(path, e.what());
  }
  if (!loaded || !error.empty()) fail(path, error.empty() ? "no glTF 2.0 file" : error);
  return document;
}

}  // namespace gnomon::ar::gltf
