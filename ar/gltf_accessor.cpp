#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "ar/gltf_document.h"

namespace gnomon::ar::gltf {

namespace {

/// Where an accessor's values lie: `count` elements, `stride` bytes apart, all inside the view.
struct Source {
  const std::uint8_t* data = nullptr;
  std::size_t count = 0, stride = 0;
};

int component_bytes(const Document& document, int type, const std::string& place) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      fail(document.path, fmt::format("{}: component type {}", place, type));
  }
}

const tinygltf::Accessor& accessor_at(const Document& document, int accessor,
                                      const std::string& place) {
  const auto& all = document.gltf.accessors;
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= all.size())
    fail(document.path,
         fmt::format("{}: accessor {} is not one of {}", place, accessor, all.size()));
  return all[static_cast<std::size_t>(accessor)];
}

/// `count` elements of `element` bytes from `offset` of a view. Throws unless they lie inside it.
Source elements(const Document& document, int view, std::uint64_t offset, std::size_t count,
                std::size_t element, bool may_stride, const std::string& place) {
  const Bytes bytes = view_bytes(document, view, place);
  const std::size_t given = document.gltf.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = may_stride && given != 0 ? given : element;
  if (stride < element || stride > 252)
    fail(document.path, fmt::format("{}: bufferView {}: byteStride {} for elements of {} bytes",
                                    place, view, stride, element));
  const std::uint64_t needed = (std::uint64_t{count} - 1) * stride + element;
  if (offset > bytes.size || needed > bytes.size - offset)
    fail(document.path,
         fmt::format("{}: {} elements from byte {} reach behind the {} bytes of bufferView {}",
                     place, count, offset, bytes.size, view));
  return {bytes.data + offset, count, stride};
}

template <class T>
T load(const std::uint8_t* data) {
  T value;
  std::memcpy(&value, data, sizeof(T));
  return value;
}

template <class T>
float normalised(const std::uint8_t* data, bool normalise) {
  const auto value = static_cast<float>(load<T>(data));
  if (!normalise) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float component(const std::uint8_t* data, int type, bool normalise) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalised<std::int8_t>(data, normalise);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalised<std::uint8_t>(data, normalise);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalised<std::int16_t>(data, normalise);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return normalised<std::uint16_t>(data, normalise);
    default:
      return load<float>(data);
  }
}

std::uint32_t index_value(const std::uint8_t* data, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *data;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(data);
    default:
      return load<std::uint32_t>(data);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Calls put(element, data) for the accessor's own values, then for the sparse ones over them.
template <class Put>
void for_each_element(const Document& document, const tinygltf::Accessor& accessor,
                      std::size_t element, bool may_stride, const std::string& place, Put put) {
  const std::size_t count = accessor.count;
  if (accessor.bufferView >= 0) {
    const Source source = elements(document, accessor.bufferView, accessor.byteOffset, count,
                                   element, may_stride, place);
    for (std::size_t i = 0; i < count; ++i) put(i, source.data + i * source.stride);
  }
  if (!accessor.sparse.isSparse) return;
  const auto& sparse = accessor.sparse;
  const auto refuse = [&](const std::string& what) {
    fail(document.path, fmt::format("{}: sparse {}", place, what));
  };
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > count)
    refuse(fmt::format("count {} of {} elements", sparse.count, count));
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) refuse("byteOffset below 0");
  if (!is_index_type(sparse.indices.componentType))
    refuse(fmt::format("index type {}", sparse.indices.componentType));
  const auto n = static_cast<std::size_t>(sparse.count);
  const auto index_bytes =
      static_cast<std::size_t>(component_bytes(document, sparse.indices.componentType, place));
  const Source indices =
      elements(document, sparse.indices.bufferView,
               static_cast<std::uint64_t>(sparse.indices.byteOffset), n, index_bytes, false, place);
  const Source values =
      elements(document, sparse.values.bufferView,
               static_cast<std::uint64_t>(sparse.values.byteOffset), n, element, false, place);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t at =
        index_value(indices.data + i * indices.stride, sparse.indices.componentType);
    if (at >= count) refuse(fmt::format("index {} of {} elements", at, count));
    put(at, values.data + i * values.stride);
  }
}

}  // namespace

Bytes view_bytes(const Document& document, int view, const std::string& place) {
  const auto& views = document.gltf.bufferViews;
  const auto& buffers = document.gltf.buffers;
  if (view < 0 || static_cast<std::size_t>(view) >= views.size())
    fail(document.path,
         fmt::format("{}: bufferView {} is not one of {}", place, view, views.size()));
  const tinygltf::BufferView& v = views[static_cast<std::size_t>(view)];
  if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= buffers.size())
    fail(document.path, fmt::format("{}: bufferView {}: buffer {} is not one of {}", place, view,
                                    v.buffer, buffers.size()));
  const auto& data = buffers[static_cast<std::size_t>(v.buffer)].data;
  if (v.byteLength < 1 || v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
    fail(document.path,
         fmt::format("{}: bufferView {}: {} bytes from byte {} reach behind the {} of buffer {}",
                     place, view, v.byteLength, v.byteOffset, data.size(), v.buffer));
  return {data.data() + v.byteOffset, v.byteLength};
}

int component_count(const Document& document, int accessor, const std::string& place) {
  switch (accessor_at(document, accessor, place).type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    case TINYGLTF_TYPE_MAT4:
      return 16;
    default:
      fail(document.path, fmt::format("{}: accessor {} has no type that is read", place, accessor));
  }
}

std::size_t value_count(const Document& document, int accessor, const std::string& place) {
  const std::size_t count = accessor_at(document, accessor, place).count;
  if (count < 1 || count > 3 * kMaxVertices)
    fail(document.path,
         fmt::format("{}: {} values; 1 to {} are read", place, count, 3 * kMaxVertices));
  return count;
}

std::vector<float> read_floats(const Document& document, int accessor, int components,
                               const std::string& place) {
  const tinygltf::Accessor& a = accessor_at(document, accessor, place);
  const std::size_t count = value_count(document, accessor, place);
  if (component_count(document, accessor, place) != components)
    fail(document.path, fmt::format("{}: accessor {} has {} components, not {}", place, accessor,
                                    component_count(document, accessor, place), components));
  if (a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    fail(document.path, fmt::format("{}: component type {}", place, a.componentType));
  const auto bytes = static_cast<std::size_t>(component_bytes(document, a.componentType, place));
  const auto n = static_cast<std::size_t>(components);
  std::vector<float> values(count * n, 0.0f);
  for_each_element(
      document, a, bytes * n, true, place, [&](std::size_t i, const std::uint8_t* data) {
        for (std::size_t c = 0; c < n; ++c)
          values[i * n + c] = component(data + c * bytes, a.componentType, a.normalized);
      });
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      fail(document.path, fmt::format("{}: accessor {}: component {} of element {} is {}", place,
                                      accessor, i % n, i / n, values[i]));
  return values;
}

std::vector<std::uint32_t> read_indices(const Document& document, int accessor,
                                        const std::string& place) {
  const tinygltf::Accessor& a = accessor_at(document, accessor, place);
  const std::size_t count = value_count(document, accessor, place);
  if (component_count(document, accessor, place) != 1 || !is_index_type(a.componentType))
    fail(document.path, fmt::format("{}: accessor {} holds no unsigned integers", place, accessor));
  const auto bytes = static_cast<std::size_t>(component_bytes(document, a.componentType, place));
  std::vector<std::uint32_t> values(count, 0);
  for_each_element(document, a, bytes, false, place, [&](std::size_t i, const std::uint8_t* data) {
    values[i] = index_value(data, a.componentType);
  });
  return values;
}

}  // namespace gnomon::ar::gltf
