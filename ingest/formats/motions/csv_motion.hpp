// One clip's joints as text: comma, semicolon, tab or blank separated.
//
//   frame,person,joint,x,y,z        one line a joint, in any order; the header names these columns, in any order, others are passed
//   0,0,left hip,0.1,0.9,2.3        over; `person` may be missing; joints by name or number, frames, persons and numbers from 0
//
//   0.1,0.9,2.3,0.2,0.5,2.3,...     one line a frame: x, y, z of every joint; a header line or none.
//                                   0,1,2,... or 1,2,3,... in line 1 numbers the columns, as pandas does
//
// A number may be missing or nan: not seen.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

struct CsvMotion {
    std::uint64_t frames = 0, persons = 1, joints = 0;
    std::vector<double> positions;  ///< (frames, persons, joints, 3); NaN where nothing was said
    bool numbered_columns = false;  ///< line 1 numbers the columns, and is no frame
};

/// `names` are the joints' names. 64 zero bytes follow `text`. Throws Error with the line and what is wrong in it.
CsvMotion read_csv_motion(std::string_view text, const std::vector<std::string>& names);

}  // namespace actformer::ingest
