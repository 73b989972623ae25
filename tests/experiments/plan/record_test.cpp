#include "experiments/plan/record.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "experiments/base/csv.h"

namespace caustics::experiments {
namespace {

TEST(RecordsCsv, BeginsWithTheColumnsOfTheContract) {
    const std::string contract =
        "trial,status,scene,method,seed,repeat,threads,isa,photons_emitted,photons_stored,nearest,"
        "alpha,mesh_resolution,polygons,beams,cone_point_tests,beam_point_tests,beam_point_hits,"
        "map_bytes,rss_start_bytes,peak_rss_bytes,parse_s,precompute_s,balance_s,render_s,total_s,"
        "cpu_s,rmse,relmse,bias,variance,mean_ratio,leak_energy,beauty_rmse,unreached_fraction,"
        "reference,reference_stderr,config_hash,code_version,";
    const std::string header = csv_line(record_columns({"nearest", "alpha", "photons"}));
    EXPECT_EQ(header.substr(0, contract.size()), contract);
    for (const char* name : {",trees,", ",trees_binned,", ",nodes,", ",tree_height,",
                             ",casters_with_face_normals,", ",flux_share_captured,"})
        EXPECT_NE(header.find(name), std::string::npos) << name;
    EXPECT_EQ(header.substr(header.size() - 9), ",photons\n") << "swept keys come last, once";
}

TEST(RecordsCsv, FillsTwoOfItsColumnsFromSweptKeys) {
    for (const std::string& name : record_columns({}))
        EXPECT_EQ(is_swept_column(name), name == "alpha" || name == "mesh_resolution") << name;
}

TEST(RecordsCsv, GivesParametersColumnsOfTheirOwnWhereTheirNamesAreTaken) {
    const std::vector<std::string> swept = {"spp", "polygons", "nearest", "alpha", "photons"};
    const std::string header = csv_line(record_columns(swept));
    const std::string own = ",method_spp,method_polygons,photons\n";
    EXPECT_TRUE(header.ends_with(own)) << header;
    const nlohmann::json record = {{"spp", 4},
                                   {"scene", {{"polygons", 12}}},
                                   {"swept", {{"spp", 64}, {"polygons", "quads"}, {"photons", 5}}}};
    const std::vector<std::string> columns = {"spp", "polygons", "method_spp", "method_polygons",
                                              "photons"};
    EXPECT_EQ(csv_line(csv_cells(record_row(record, columns))), "4,12,64,quads,5\n");
}

TEST(RecordsCsv, HasTheColumnsThatTheManualTells) {
    std::ifstream manual(CAUSTICS_SOURCE_DIR "/results/records.md");
    std::vector<std::string> told;
    for (std::string line; std::getline(manual, line);)
        if (line.rfind("| `", 0) == 0) told.push_back(line.substr(3, line.find('`', 3) - 3));
    EXPECT_EQ(told, record_columns({}));
}

TEST(RecordsCsv, HoldsNoFormulas) {
    const std::vector<std::string> columns = {"trial", "scene", "message"};
    const auto cells = [&](const std::string& text) {
        return csv_cells(record_row({{"trial", "a"}, {"scene", {{"name", text}}}}, columns));
    };
    for (const std::string text :
         {"=1+1", "+cmd", "-2+3", "@SUM(A1)", "\t=1", "\r=1", "'=1", "'-1"})
        EXPECT_EQ(cells(text)[1], "'" + text);
    for (const std::string text : {"ring", "-0.5", "-1e-5", "", "a=b", "'a"})
        EXPECT_EQ(cells(text)[1], text);
}

TEST(RecordsCsv, LeavesEmptyWhatDoesNotApply) {
    const nlohmann::json record = {
        {"trial", "a, b"},
        {"seed", 12345678901234},
        {"counters", {{"nodes", 7}}},
        {"method",
         {{"parameters", {{"nearest", 50}}}, {"resolved", {{"flux_share_captured", 0.25}}}}},
        {"swept", {{"alpha", 0.1}, {"bound", "hybrid"}}},
        {"metrics", {{"rmse", 1.0 / 3}, {"relmse", nullptr}}}};
    const std::vector<std::string> columns = {
        "trial", "seed",   "nearest", "alpha", "bound",
        "rmse",  "relmse", "beams",   "nodes", "flux_share_captured"};
    const std::vector<nlohmann::json> row = record_row(record, columns);
    EXPECT_EQ(csv_line(csv_cells(row)),
              "\"a, b\",12345678901234,50,0.1,hybrid,0.3333333333333333,,,7,0.25\n");
    EXPECT_EQ(json_line(row, columns),
              R"({"trial":"a, b","seed":12345678901234,"nearest":50,"alpha":0.1,"bound":"hybrid",)"
              R"("rmse":0.3333333333333333,"relmse":null,"beams":null,"nodes":7,)"
              R"("flux_share_captured":0.25})"
              "\n");
}

}  // namespace
}  // namespace caustics::experiments
