#include "base/hdf5/variable_texts.hpp"

#include <algorithm>
#include <cstring>

#include "base/hdf5/little_endian.hpp"

namespace actformer::hdf5 {
namespace {

constexpr std::size_t reference_size = 16, heap_header = 16, object_header = 16;

/// Objects of one heap: index -> bytes.
using Heap = std::map<std::uint16_t, std::string>;

/// Empty where there is no heap at `address`. Its bytes come off `left`: all heaps together are no larger than the file.
Heap heap_at(std::uint64_t address, const FileBytes& file, std::uint64_t& left) {
    const auto header = file(address, heap_header);
    if (header.size() < heap_header || !header.starts_with(std::string_view("GCOL\1", 5))) return {};
    const auto size = number_in<std::uint64_t>(header, 8);
    if (size < heap_header || size > left) return {};
    left -= size;
    const auto bytes = file(address, size);
    Heap heap;
    for (std::size_t at = heap_header; at + object_header <= bytes.size();) {
        const auto index = number_in<std::uint16_t>(bytes, at);
        const auto length = number_in<std::uint64_t>(bytes, at + 8);
        at += object_header;
        if (index == 0 || length > bytes.size() - at) break;  // index 0 is what is left of the heap
        heap[index] = bytes.substr(at, length);
        at += std::min<std::size_t>((length + 7) / 8 * 8, bytes.size() - at);
    }
    return heap;
}

}  // namespace

bool read_variable_texts(std::string_view references, const FileBytes& file, std::uint64_t most,
                         std::vector<std::string>& texts) {
    std::uint64_t left = most;
    std::map<std::uint64_t, Heap> heaps;
    for (std::size_t at = 0; at + reference_size <= references.size(); at += reference_size) {
        const auto length = number_in<std::uint32_t>(references, at);
        auto& text = texts.emplace_back();
        if (length == 0) continue;
        const auto where = number_in<std::uint64_t>(references, at + 4);
        auto heap = heaps.find(where);
        if (heap == heaps.end()) heap = heaps.emplace(where, heap_at(where, file, left)).first;
        const auto found =
            heap->second.find(static_cast<std::uint16_t>(number_in<std::uint32_t>(references, at + 12)));
        if (found == heap->second.end() || length > found->second.size() || length > most) return false;
        most -= length;
        text = found->second.substr(0, length);
        text.resize(std::strlen(text.c_str()));
    }
    return true;
}

}  // namespace actformer::hdf5
