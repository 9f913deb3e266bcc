// Files in memory that is used again are those made in memory of their own.
#include "base/hdf5/file_memory.hpp"

#include <gtest/gtest.h>

#include "base/hdf5/writer.hpp"

using namespace actformer;

namespace {

/// The image of a file with `rows` of a motion, and names as long as they are many.
std::string image_of(hdf5::Writer&& file, std::size_t rows) {
    std::vector<float> motion(rows * 6);
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i] = static_cast<float>(i + rows) * 0.5F;
    file.write_pieces("motion", {rows, 2, 3}, {motion}, 256);
    file.write_strings("clip/name", std::vector<std::string>(rows / 10, std::string(rows % 40, 'x')));
    return std::string(file.image());
}

}  // namespace

TEST(FileMemory, ServesOneFileAfterTheOther) {
    hdf5::FileMemory memory;
    for (const std::size_t rows : {3000U, 10U, 100'000U, 2000U, 90'000U}) {
        const std::size_t bytes = rows * 6 * sizeof(float);
        const auto own = image_of(hdf5::Writer(bytes), rows);
        EXPECT_EQ(image_of(hdf5::Writer(memory, bytes), rows), own) << rows;
        EXPECT_EQ(image_of(hdf5::Writer(memory, 1), rows), own) << rows << ", more than expected";
    }
}
