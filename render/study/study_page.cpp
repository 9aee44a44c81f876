#include "study/study_page.h"

#include <cmath>
#include <cstdlib>

#include "html_text.h"
#include "study/peer.h"
#include "study/study_plots.h"
#include "text/short_text.h"

namespace isoparm {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #fff; --ink: #1b1d21; --soft: #5a6068; --line: #d4d8dd; --band: #f4f6f8; --bad: #a03020; }
@media (prefers-color-scheme: dark) { :root { --paper: #15171a; --ink: #e6e8eb; --soft: #a3abb5; --line: #3a4048; --band: #1d2024; --bad: #f09080; } }
body { margin: 2rem auto; padding: 0 1.25rem; max-width: 72rem; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin-bottom: .3rem; } h2 { font-size: 1.25rem; margin-top: 2.4rem; }
p, li { max-width: 48rem; } .soft { color: var(--soft); }
figure { margin: 0; } figcaption { color: var(--soft); font-size: .9rem; margin-top: .35rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(28rem, 100%), 1fr)); gap: 1.6rem; }
.figures svg, .figures img { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--line); border-radius: 4px; box-sizing: border-box; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .86rem; font-variant-numeric: tabular-nums; }
th, td { padding: .28rem .6rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
thead th { position: sticky; top: 0; background: var(--paper); border-bottom: 2px solid var(--soft); vertical-align: bottom; }
td.number, th.number { text-align: right; white-space: nowrap; }
tr.first td { border-top: 2px solid var(--line); } tbody tr:nth-child(even) td { background: var(--band); }
.missed { color: var(--bad); }
code { font-size: .92em; overflow-wrap: anywhere; }
)";

/// A number as a reader wants it: whole ones and large ones whole, others with four digits.
std::string brief(const std::string& number) {
    if (number.find_first_of(".e") == std::string::npos) return number;
    const double x = std::strtod(number.c_str(), nullptr);
    return x >= 1000 && x < 1e15 ? short_text(std::round(x), 15) : short_text(x);
}

/// Without the declaration, and with names of its own: several stand on one page.
std::string inlined(std::string svg, std::size_t number, const std::string& label) {
    if (const auto start = svg.find("<svg"); start != std::string::npos) svg.erase(0, start);
    const std::string own = "plot" + std::to_string(number) + "-";
    for (const char* mark : {" id=\"", "url(#", "href=\"#"})
        for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + 1))
            svg.insert(at + std::string(mark).size(), own);
    const auto end = svg.find("<svg") + 4;
    svg.insert(end, " role=\"img\" aria-label=\"" + escaped(label) + "\"");
    return svg;
}

std::string table(const std::vector<StudyRow>& rows) {
    std::string text = "<div class=\"scroll\"><table>\n<thead><tr>";
    for (const StudyColumn& c : study_columns())
        text += std::string("<th scope=\"col\"") + (c.number ? " class=\"number\"" : "") + " title=\"" + escaped(c.meaning) + "\">" +
                c.name + "</th>";
    text += "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        text += i > 0 && rows[i].run.method != rows[i - 1].run.method ? "<tr class=\"first\">" : "<tr>";
        for (const StudyColumn& c : study_columns()) {
            const std::string value = c.value(rows, i);
            const bool missed = value == "not reached";
            text += std::string("<td") +
                    (c.number ? " class=\"number\""
                     : missed ? " class=\"missed\""
                              : "") +
                    ">" + (c.number ? brief(value) : escaped(value)) + "</td>";
        }
        text += "</tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

std::string meanings() {
    std::string text =
        "<table><thead><tr><th scope=\"col\">column</th><th scope=\"col\">unit</th><th scope=\"col\">meaning</th></tr></thead><tbody>\n";
    for (const StudyColumn& c : study_columns())
        text += std::string("<tr><td><code>") + c.name + "</code></td><td>" + c.unit + "</td><td>" + escaped(c.meaning) + "</td></tr>\n";
    return text + "</tbody></table>\n";
}

std::string orders(const StudyFacts& facts, const std::vector<StudyRow>& rows) {
    std::string text =
        "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">method</th><th scope=\"col\">what it does</th><th scope=\"col\" "
        "class=\"number\">order, certified</th>"
        "<th scope=\"col\" class=\"number\">order, sampled</th><th scope=\"col\" class=\"number\">points</th></tr></thead><tbody>\n";
    for (const std::string& m : facts.methods) {
        const MethodOrders o = fitted_orders(rows, m);
        const StudyMethod* method = find_any_study_method(m);
        text += "<tr><td>" + escaped(m) + "</td><td>" + (method ? escaped(method->summary) : "") + "</td><td class=\"number\">" +
                (o.certified ? short_text(o.certified->order, 3) : "") + "</td><td class=\"number\">" + (o.sampled ? short_text(o.sampled->order, 3) : "") +
                "</td><td class=\"number\">" + (o.certified ? std::to_string(o.certified->points) : "") + "</td></tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

}  // namespace

std::string study_page(const StudyFacts& facts, const std::vector<StudyRow>& rows, const std::vector<std::string>& svg,
                       const std::vector<std::pair<std::string, std::string>>& png) {
    std::size_t missed = 0;
    for (const StudyRow& r : rows) missed += !r.run.reached;
    std::string text =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, "
        "initial-scale=1\">\n"
        "<meta name=\"generator\" content=\"isoparm study\">\n<title>Tessellation study: " +
        escaped(facts.title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n";
    text += "<h1>Tessellation study: " + escaped(facts.title) + "</h1>\n<p class=\"soft\">" + std::to_string(facts.methods.size()) +
            " methods, " + std::to_string(rows.size()) + " runs" +
            (missed ? ", " + std::to_string(missed) + " of which did not reach their tolerance" : "") + ".</p>\n";
    text +=
        "<p>Every mesh has the same certificate: <b>certified error</b> is proved to bound the distance of mesh and surface, both ways, "
        "with every rounding error counted. "
        "<b>Sampled error</b> is the largest distance that was seen at some points, and proves nothing.</p>\n";
    text +=
        "<h2>Methods and orders</h2>\n<p>The order <i>p</i> is fitted by least squares to log(error) over log(triangles), error ~ "
        "<i>h</i><sup><i>p</i></sup> with "
        "<i>h</i> = triangles<sup>&minus;1/2</sup>, over the runs that reached their tolerance. Two is the order of flat triangles; more "
        "means that coarse tolerances take more than their share of triangles.</p>\n" +
        orders(facts, rows);
    const auto plots = study_plots(rows, facts.methods);
    text += "<h2>Diagrams</h2>\n<p class=\"soft\">The same as SVG and PDF, for print, lie beside this page.</p>\n<div class=\"figures\">\n";
    for (std::size_t i = 0; i < std::min(plots.size(), svg.size()); ++i)
        text +=
            "<figure>" + inlined(svg[i], i, plots[i].plot.title) + "<figcaption>" + escaped(plots[i].caption) + "</figcaption></figure>\n";
    text += "</div>\n";
    if (!png.empty()) {
        text += "<h2>Where the error is</h2>\n<p>Error of each triangle at the tolerance " + short_text(facts.heat_tolerance, 3) +
                " scene units, as a part of that tolerance, on a logarithmic scale; a hundredth and less is darkest. Where the certified "
                "error is far above the sampled one, "
                "either the triangle is too coarse for the distance along the normal, so that the distance at equal parameters counts, or "
                "a neighbour at an angle is in the way.</p>\n<div class=\"figures\">\n";
        for (const auto& [name, bytes] : png)
            text += "<figure><img alt=\"" + escaped(name) + "\" src=\"data:image/png;base64," + base64(bytes) + "\"><figcaption><code>" +
                    escaped(name) + "</code></figcaption></figure>\n";
        text += "</div>\n";
    }
    text += "<h2>All runs</h2>\n" + table(rows) + "<h2>What the columns mean</h2>\n" + meanings() +
            "<h2>Where this comes from</h2>\n<div class=\"scroll\"><table><tbody>\n";
    for (const auto& [what, value] : facts.provenance)
        text += "<tr><th scope=\"row\">" + escaped(what) + "</th><td><code>" + escaped(value) + "</code></td></tr>\n";
    return text + "</tbody></table></div>\n</body>\n</html>\n";
}

}  // namespace isoparm
