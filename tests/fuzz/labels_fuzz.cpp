// Tables of labels on arbitrary bytes: every row that is taken is found again under its own file.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "ingest/formats/labels_file.hpp"

using namespace actformer;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    const std::string bytes(data, data + size);
    try {
        const ingest::LabelsFile labels(bytes, "fuzz");
        for (std::size_t r = 0; r < std::min<std::size_t>(labels.rows().size(), 50); ++r) {
            const auto& row = labels.rows()[r];
            if (row.fields.size() != labels.fields().size() || row.action.empty()) std::abort();
            if (row.end && row.start.value_or(0) >= *row.end) std::abort();
            const auto found = labels.find(row.file.starts_with("./") ? row.file : "/x/" + row.file);
            if (!row.file.starts_with("./") && !row.file.starts_with("/") && found.empty()) std::abort();
        }
    } catch (const Error& e) {
        if (std::string(e.what()).find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
