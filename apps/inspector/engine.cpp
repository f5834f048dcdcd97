// The rasterizer for a page: what a browser calls of the WebAssembly module. Frames are in numbered
// slots. Results lie in memory that is valid until the next call.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/inspector/inspection.h"
#include "apps/inspector/lab_frame.h"
#include "apps/inspector/lab_state.h"
#include "golden/hash.h"
#include "raster/frame_format.h"

#define GNOMON_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {

using namespace gnomon;
using apps::inspector::Inspection;

std::map<int, std::unique_ptr<Inspection>>& slots() {
  static std::map<int, std::unique_ptr<Inspection>> all;
  return all;
}
Inspection& in_slot(int slot) { return *slots().at(slot); }

std::vector<std::uint8_t>& result() {
  static std::vector<std::uint8_t> bytes;
  return bytes;
}

const std::uint8_t* give(const std::string& text) {
  result().assign(text.begin(), text.end());
  return result().data();
}

template <class T>
void append(const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  result().insert(result().end(), bytes, bytes + values.size() * sizeof(T));
}

}  // namespace

GNOMON_EXPORT(allocate) void* allocate(std::size_t bytes) { return std::malloc(bytes); }
GNOMON_EXPORT(release) void release(void* memory) { std::free(memory); }
/// Bytes of the last result.
GNOMON_EXPORT(result_size) std::size_t result_size() { return result().size(); }

/// A frame file's bytes.
GNOMON_EXPORT(load) void load(int slot, const std::uint8_t* bytes, std::size_t size) {
  auto frame =
      std::make_shared<raster::RecordedFrame>(raster::decode_frame({bytes, size}, 1u << 30));
  slots()[slot] = std::make_unique<Inspection>(frame, frame->frame);
}

/// A lab state as JSON; what was loaded before is gone. The result is the state with all fields.
GNOMON_EXPORT(load_lab)
const std::uint8_t* load_lab(int slot, const char* json, std::size_t size) {
  const apps::inspector::LabState state = apps::inspector::read_lab_state({json, size});
  const auto lab = apps::inspector::record_lab(state);
  slots()[slot] = std::make_unique<Inspection>(lab, lab->frame);
  return give(apps::inspector::to_json(state));
}

/// The frame's bytes, for a file.
GNOMON_EXPORT(save) const std::uint8_t* save(int slot) {
  result() = raster::encode_frame(in_slot(slot).frame());
  return result().data();
}

GNOMON_EXPORT(describe) const std::uint8_t* describe(int slot, int in_brief) {
  return give(in_slot(slot).description(in_brief != 0));
}

GNOMON_EXPORT(seek) void seek(int slot, std::size_t commands) { in_slot(slot).seek(commands); }

/// Pixels row after row from the bottom row: r, g, b, a bytes; depths of 4 bytes; stencils of 1.
GNOMON_EXPORT(read_buffer) const std::uint8_t* read_buffer(int slot, std::size_t number) {
  result().clear();
  const auto& buffer = in_slot(slot).buffers()[number];
  if (const auto* color = std::get_if<raster::ColorBuffer*>(&buffer))
    result() = (*color)->to_rgba8_rows();
  else if (const auto* depth = std::get_if<raster::DepthBuffer*>(&buffer))
    append((*depth)->to_rows());
  else
    result() = std::get<raster::StencilBuffer*>(buffer)->to_rows();
  return result().data();
}

/// Five planes of 16-bit counts: stencil failed, depth failed, passed, raised, lowered.
GNOMON_EXPORT(fates) const std::uint8_t* fates(int slot, std::size_t first, std::size_t last) {
  const raster::DrawFates told = in_slot(slot).fates(first, last);
  result().clear();
  for (const auto* plane :
       {&told.stencil_failed, &told.depth_failed, &told.passed, &told.raised, &told.lowered})
    append(*plane);
  return result().data();
}

/// Five 32-bit integers an edge: x0, y0, x1, y1 in 1/256 pixel, kind (wireframe.h).
GNOMON_EXPORT(wires) const std::uint8_t* wires(int slot, std::size_t command) {
  result().clear();
  append(in_slot(slot).wires(command));
  return result().data();
}

GNOMON_EXPORT(history)
const std::uint8_t* history(int slot, std::size_t pass, int x, int y, std::size_t commands) {
  return give(in_slot(slot).history(pass, x, y, commands));
}

/// "KIND FORMAT WIDTHxHEIGHT HASH" a line, of all buffers as they are now.
GNOMON_EXPORT(hashes) const std::uint8_t* hashes(int slot) {
  std::string text;
  for (const raster::Buffer& buffer : in_slot(slot).buffers().save())
    text += golden::sentence(golden::hash_of(buffer)) + "\n";
  return give(text);
}
