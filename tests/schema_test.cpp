// schema_test.cpp -- scenes/scene.schema.json has the types of the registry, each with its keys and no others.
#include <gtest/gtest.h>
#include <json/json.h>

#include <map>
#include <set>
#include <sstream>

#include "run_program.h"
#include "scene/registry.h"

namespace isoparm {
namespace {

using Keys = std::map<std::string, std::set<std::string>>;

/// Keys by type, and of coons_triangle by method ("coons_triangle bbg_c1"), besides those two.
Keys keys_of_schema(const char* definitions) {
    ::Json::Value schema;
    std::istringstream(test::read_all(test::source_folder() + "/scenes/scene.schema.json")) >> schema;
    Keys keys;
    for (const auto& d : schema["$defs"][definitions]["oneOf"]) {
        const auto& properties = d["properties"];
        EXPECT_FALSE(d["additionalProperties"].asBool() || d["additionalProperties"].isNull()) << properties["type"];
        const std::string type = properties["type"]["const"].asString();
        std::vector<std::string> names{type};
        if (const auto& m = properties["method"]; !m.isNull()) {
            names.clear();
            for (const auto& method : m.isMember("enum") ? m["enum"] : ::Json::Value(::Json::arrayValue)) names.push_back(type + " " + method.asString());
            if (m.isMember("const")) names.push_back(type + " " + m["const"].asString());
        }
        for (const auto& name : names)
            for (const auto& key : properties.getMemberNames())
                if (key != "type" && key != "method") keys[name].insert(key);
        for (const auto& key : d["required"]) EXPECT_TRUE(properties.isMember(key.asString())) << type << " requires " << key;
    }
    return keys;
}
template <class Types> Keys keys_of_registry(const Types& types) {
    Keys keys;
    for (const auto& t : types) {
        if (t.name != std::string("coons_triangle")) {
            keys[t.name] = {t.keys.begin(), t.keys.end()};
            continue;
        }
        std::set<std::string> all{"method"};
        for (const auto& [method, own] : triangle_methods()) {
            keys[std::string(t.name) + " " + method] = {own.begin(), own.end()};
            all.insert(own.begin(), own.end());
        }
        EXPECT_EQ(all, (std::set<std::string>{t.keys.begin(), t.keys.end()})) << "the methods have the keys of the type";
    }
    return keys;
}
TEST(Schema, KnowsEveryTypeWithItsKeysAndNoOthers) {
    EXPECT_EQ(keys_of_schema("curve_definition"), keys_of_registry(curve_types()));
    EXPECT_EQ(keys_of_schema("surface_definition"), keys_of_registry(surface_types()));
}

}  // namespace
}  // namespace isoparm
