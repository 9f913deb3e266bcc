// Rotations of SMPL's joints, made up: persons side by side who walk on the spot, swing their arms and turn.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "ingest/dataset/motions_file.hpp"
#include "ingest/smpl/smpl24.hpp"

namespace actformer::test {

/// (frames, persons, 25, 6)
inline ingest::Motion turning_motion(const std::string& name, std::uint32_t frames, std::uint32_t persons) {
    ingest::Motion motion{name, frames, persons, 25, 6, {}};
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::uint32_t p = 0; p < persons; ++p) {
            const double phase = 0.25 * t + p;
            for (std::size_t j = 0; j < 24; ++j) {
                // Angles about x, and about z: arms hang down, all limbs swing.
                double x = 0, z = 0;
                if (j == 1 || j == 2) x = (j == 1 ? 0.5 : -0.5) * std::sin(phase);
                if (j == 4 || j == 5) x = 0.4 + 0.3 * std::cos(phase + static_cast<double>(j));
                if (j == 16 || j == 17) z = j == 16 ? -1.2 : 1.2;
                if (j == 18 || j == 19) x = 0.2 * std::sin(phase);
                if (j == 3 || j == 12) x = 0.1 * std::sin(phase);
                const double cx = std::cos(x), sx = std::sin(x), cz = std::cos(z), sz = std::sin(z);
                if (j == 0) {  // about y
                    const double a = 0.2 * t, c = std::cos(a), s = std::sin(a);
                    for (const double r : {c, 0.0, s, 0.0, 1.0, 0.0})
                        motion.values.push_back(static_cast<float>(r));
                    continue;
                }
                // Z X: rows cz, -sz cx, sz sx; sz, cz cx, -cz sx.
                for (const double r : {cz, -sz * cx, sz * sx, sz, cz * cx, -cz * sx})
                    motion.values.push_back(static_cast<float>(r));
            }
            for (const double r : {1.1 * p, 0.05 * std::sin(phase), 0.02 * t, 0.0, 0.0, 0.0})
                motion.values.push_back(static_cast<float>(r));
        }
    return motion;
}

/// A file of one such motion, on the generic skeleton; its name is "A001_0".
inline void write_turning_motion(const std::filesystem::path& path, std::uint32_t frames = 20,
                                 std::uint32_t persons = 1) {
    ingest::Subjects subjects;
    subjects.representation = ingest::Representation::rot6d;
    subjects.topology = ingest::smpl24();
    subjects.rest = ingest::generic_skeleton().rest();
    subjects.persons = persons;
    subjects.classes = {"walk on the spot"};
    ingest::MotionsWriter file(path);
    file.describe(subjects);
    file.add("A001_0", turning_motion("A001_0", frames, persons));
    file.finish();
}

}  // namespace actformer::test
