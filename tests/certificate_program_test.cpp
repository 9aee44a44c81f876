// tessellate --certificate and verify --certificate from the command line.
#include "expect_program.h"

namespace isoparm::test {
namespace {

TEST(CertificateProgram, FilesOfEveryFormatAreProvedWithTheirMesh) {
    const TemporaryFolder t;
    for (const char* mesh : {"m.ply", "m.obj", "m.stl"}) {
        ASSERT_EQ(run("tessellate " + scene("sphere") + " --quiet --tolerance 1e-2rel --certificate " + t / "c.json" + " --report " + t / "r.json -o " + t / mesh).code, 0);
        const Outcome o = run("verify " + t / mesh + " --certificate " + t / "c.json" + " --against " + scene("sphere") + " --json");
        ASSERT_EQ(o.code, 0) << o.out << o.err;
        const Json::Value v = parsed(o.out), report = parsed(read_all(t / "r.json")), file = parsed(read_all(t / "c.json"));
        EXPECT_TRUE(v["proved"].asBool());
        EXPECT_GE(v["triangles"].asInt(), report["triangles"].asInt());
        EXPECT_NEAR(v["certified_error"].asDouble(), report["certified_error"].asDouble(), 1e-12);
        EXPECT_EQ(file["isoparm_certificate"].asInt(), 1);
        EXPECT_EQ(file["sha256"].asString().size(), 64u);
        EXPECT_EQ(file["measure"].asString(), "geometric");
        double most = 0;
        for (const auto& p : file["patches"])
            for (const auto& triangle : p["triangles"]) most = std::max(most, triangle["bound"].asDouble());
        EXPECT_LE(most, file["certified_error"].asDouble());
        EXPECT_GE(most, 0.999 * file["certified_error"].asDouble());
    }
}

TEST(CertificateProgram, WhatIsNotProvedEndsWithCode2) {
    const TemporaryFolder t;
    const std::string against = " --against " + scene("coons"), certificate = "verify --certificate ";
    ASSERT_EQ(run("tessellate " + scene("coons") + " --quiet --measure parametric --tolerance 2e-3rel --certificate " + t / "c.json" + " -o " + t / "m.ply").code, 0);
    ASSERT_EQ(run("tessellate " + scene("coons") + " --quiet --tolerance 5e-3rel -o " + t / "other.ply").code, 0);
    expect(certificate + t / "c.json" + against, 0, "PROVED");
    expect(certificate + t / "c.json" + against + " " + t / "m.ply", 0, "PROVED");
    expect(certificate + t / "c.json" + against + " --tolerance 2e-3rel", 0, "holds");
    expect(certificate + t / "c.json" + against + " --tolerance 1e-3rel", 2, "EXCEEDED");
    expect(certificate + t / "c.json" + against + " " + t / "other.ply", 2, "is not the certificate's");
    expect(certificate + t / "c.json" + " --against " + scene("sphere"), 2, "is not the scene");
    std::string text = read_all(t / "c.json");
    const std::size_t bound = text.find("\"bound\": 0.0") + std::string("\"bound\": 0.0").size();
    std::string small = text;
    small[bound] = '0', small[bound + 1] = '0', small[bound + 2] = '0';  // a hundred times smaller, or more
    write_all(t / "small.json", small);
    expect(certificate + t / "small.json" + against, 2, "EXCEEDED, at least");
    write_all(t / "cut.json", text.substr(0, text.size() / 2));
    expect(certificate + t / "cut.json" + against, 65, "cut.json:");
    expect(certificate + t / "none.json" + against, 4, "none.json");
    write_all(t / "scene.json", read_all(source_folder() + "/scenes/coons.json") + "\n");
    expect(certificate + t / "c.json" + " --against " + t / "scene.json", 2, "is not the scene");
}

TEST(CertificateProgram, ClaimsThatAreNotSoAreFound) {
    const TemporaryFolder t;
    const std::string against = " --against " + scene("coons"), certificate = "verify --certificate ";
    ASSERT_EQ(run("tessellate " + scene("coons") + " --quiet --tolerance 1e-2 --certificate " + t / "g.json" + " -o " + t / "m.ply").code, 0);
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string other = read_all(t / "g.json");
        other.replace(other.find(from), from.size(), to);
        write_all(t / "other.json", other);
        return certificate + t / "other.json" + against;
    };
    expect(changed("\"measure\": \"geometric\"", "\"measure\": \"banana\""), 65, R"(found "\"banana\"", expected "geometric" or "parametric")");
    expect(changed("\"measure\": \"geometric\"", "\"measure\": \"parametric\""), 2, "which proves the geometric measure only");
    expect(changed("\"name\": \"", "\"name\": \"no"), 2, "found the name \"no");
    expect(changed("certificate\": 1", "certificate\": 2"), 65, R"(found "2", expected version 1)");
    expect(changed("\"method\": \"", "\"method\": \"un"), 65, R"(found "\"un)");
}

TEST(CertificateProgram, SurfaceAndParametersAreTheCertificatesOwn) {
    const TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + scene("teapot") + " --surface teapot/teapot#7 --quiet --tolerance 1e-2 --certificate " + t / "c.json" + " -o " + t / "m.ply").code, 0);
    expect("verify --certificate " + t / "c.json" + " --against " + scene("teapot") + " " + t / "m.ply", 0, "1 patches");
    const std::string again = "tessellate " + scene("teapot") + " --surface teapot/teapot#7 --quiet --tolerance 1e-2 --certificate - -o " + t / "m.ply";
    EXPECT_EQ(run(again).out, test::read_all(t / "c.json")) << "- is standard output";
    expect(again + " --report -", 64, "both go to standard output");
    for (const char* o : {"--surface teapot", "--set a=1", "--gap 0.1", "--watertight"}) expect("verify --certificate " + t / "c.json" + " --against " + scene("teapot") + " " + o, 64, "does not go with --certificate");
    expect("verify --certificate " + t / "c.json", 64, "--against is missing");
    expect("tessellate " + scene("teapot") + " -o " + t / "m.ply --certificate " + t / "m.ply", 64, "too, expected another one");
}

TEST(CertificateProgram, SurfacesWithoutAreaAreToldAndNothingIsWritten) {
    const TemporaryFolder t;
    write_all(t / "s.json", R"({"isoparm": 1, "curves": {}, "surfaces": {"S": {"type": "bezier_triangle", "degree": 1,
        "points": [[[0, 2, 0], [0, 2, 0]], [[0, 3, 1]]]}}, "objects": [{"surface": "S"}]})");
    expect("tessellate " + t / "s.json" + " --tolerance 0.1 -o " + t / "m.ply --certificate " + t / "c.json", 2, "has triangles without area only");
    EXPECT_TRUE(read_all(t / "c.json").empty() && read_all(t / "m.ply").empty());
    expect("tessellate " + t / "s.json" + " --tolerance 0.1 -o " + t / "m.ply", 0, "certified error");
}

}  // namespace
}  // namespace isoparm::test
