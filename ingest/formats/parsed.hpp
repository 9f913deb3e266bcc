// Files of many clips: a broken one leaves the others sound, and all cores make them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// What `make` gives; where it throws Error, a broken clip: "PLACE: what is wrong", or only that where `place` is empty.
template <typename Make>
ParsedClip made_or_broken(const std::string& place, Make make) {
    try {
        return make();
    } catch (const Error& e) {
        return Rejection{Rejection::Kind::broken,
                         place.empty() ? e.what() : fmt::format("{}: {}", place, e.what())};
    }
}

/// Makes `count` clips on as many threads as the sink has, a lot at a time, and hands them to `sink` in their order. `bytes(i)` says from how many bytes of the
/// file clip i is read; `read` is called with the bytes of each lot once they are read.
template <typename Bytes, typename Make, typename Read>
void make_in_order(std::size_t count, ClipSink& sink, Bytes bytes, Make make, Read read) {
    constexpr std::size_t at_once = std::size_t{8} << 20;
    std::vector<ParsedClip> lot;
    for (std::size_t first = 0; first < count; first += lot.size()) {
        std::size_t last = first, in_lot = 0;
        while (last < count && in_lot < at_once) in_lot += bytes(last++);
        lot.clear();
        lot.resize(last - first);
        parallel_for(lot.size(), sink.threads(), [&](std::size_t i, unsigned) { lot[i] = make(first + i); });
        read(in_lot);
        for (auto& clip : lot) sink.take(std::move(clip));
    }
}

}  // namespace actformer::ingest
