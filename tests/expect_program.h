// expect_program.h -- what tests of the program from its command line have in common.
#pragma once
#include <gtest/gtest.h>
#include <json/json.h>

#include <sstream>
#include <string>

#include "run_program.h"

namespace isoparm::test {

/// The path of a scene of the program, quoted for the shell.
inline std::string scene(const std::string& name) { return "'" + source_folder() + "/scenes/" + name + ".json'"; }

inline Json::Value parsed(const std::string& text) {
    Json::Value v;
    std::istringstream in(text);
    std::string errors;
    EXPECT_TRUE(Json::parseFromStream(Json::CharReaderBuilder(), in, &v, &errors)) << errors << text;
    return v;
}

/// It ends with `code` and says `message`, on whichever stream.
inline void expect(const std::string& arguments, int code, const std::string& message) {
    const Outcome o = run(arguments);
    EXPECT_EQ(o.code, code) << arguments << "\n" << o.out << o.err;
    EXPECT_NE((o.out + o.err).find(message), std::string::npos) << arguments << "\n" << o.out << o.err;
}

}  // namespace isoparm::test
