/* bench_style.h: the report's style sheet. Methods are m0 to m9, passes p0 to p9; a reader's system
 * chooses between light and dark. */
#ifndef CLI_BENCH_STYLE_H
#define CLI_BENCH_STYLE_H

#define BENCH_STYLE \
    ":root{color-scheme:light dark;--back:#fcfcfa;--card:#f1f2ee;--ink:#1d2420;--faint:#5f6b64;" \
    "--line:#dcdfd8;--m0:#1f5fc4;--m1:#8a6420;--m2:#5d6a77;--m3:#bb4519;--m4:#2b8446;--m5:#0b8189;" \
    "--m6:#c01f58;--m7:#7440bd;--m8:#937000;--m9:#0e120f}\n" \
    "@media(prefers-color-scheme:dark){:root{--back:#121614;--card:#1c2220;--ink:#e4e9e4;" \
    "--faint:#9aa69f;--line:#333c37;--m0:#79aefc;--m1:#cfa565;--m2:#a9b6c4;--m3:#f28c5e;" \
    "--m4:#62cf88;--m5:#4acdd6;--m6:#fb7fae;--m7:#bd9afd;--m8:#e3c04c;--m9:#fafcf9}}\n" \
    "*{box-sizing:border-box}\n" \
    "body{font:15px/1.5 system-ui,sans-serif;background:var(--back);color:var(--ink);" \
    "margin:0 auto;padding:2.5em 2em 4em;max-width:84em}\n" \
    "h1{font-size:2em;line-height:1.2;margin:0}h2{font-size:1.4em;margin:0 0 .1em}" \
    "h3{font-size:1em;margin:1.6em 0 .4em}\n" \
    "p{margin:.4em 0;max-width:60em}.faint,figcaption,.legend{color:var(--faint)}\n" \
    "header p:first-of-type{font-size:1.1em}section{margin-top:3em;padding-top:2em;" \
    "border-top:1px solid var(--line)}\n" \
    "pre{background:var(--card);padding:1em 1.2em;border-radius:8px;font-size:13px;overflow-x:auto}\n" \
    ".wide{overflow-x:auto}table{border-collapse:collapse;font-size:12.5px;" \
    "font-variant-numeric:tabular-nums;margin:.8em 0}\n" \
    "th,td{padding:.28em .55em;border-bottom:1px solid var(--line);text-align:right;" \
    "white-space:nowrap}th{font-weight:600;vertical-align:bottom}th.text{white-space:normal;" \
    "min-width:3.6em}\n" \
    "th[colspan]{text-align:center;border-left:1px solid var(--line)}" \
    "td:first-child,th:first-child{text-align:left;font-weight:600;padding-left:0}\n" \
    "td.best{font-weight:700;background:color-mix(in srgb,var(--m4) 16%,transparent)}\n" \
    ".m0{--c:var(--m0)}.m1{--c:var(--m1)}.m2{--c:var(--m2)}.m3{--c:var(--m3)}.m4{--c:var(--m4)}" \
    ".m5{--c:var(--m5)}.m6{--c:var(--m6)}.m7{--c:var(--m7)}.m8{--c:var(--m8)}.m9{--c:var(--m9)}\n" \
    "td[class^=m],.name,figcaption b{color:var(--c)}\n" \
    ".plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,30em),1fr));" \
    "gap:1em 2em;margin:1em 0}svg.plot{width:100%;height:auto}\n" \
    "svg text{font:12px system-ui,sans-serif;fill:var(--ink)}svg text.faint{fill:var(--faint)}" \
    "svg text.title{font-weight:600}\n" \
    "svg g text{fill:var(--c);font-weight:600}svg .lead{stroke:var(--c);stroke-opacity:.45}" \
    "svg .method{fill:var(--c);stroke:var(--back);stroke-width:1.5}\n" \
    "svg .grid{stroke:var(--line)}svg .axis{fill:none;stroke:var(--faint)}" \
    "svg .growth{fill:none;stroke:var(--c);stroke-width:2}\n" \
    "svg .best{fill:none;stroke:var(--m4);stroke-width:9;stroke-opacity:.2;" \
    "stroke-linejoin:round;stroke-linecap:round}\n" \
    "svg .noise{stroke:var(--faint);stroke-dasharray:5 4}\n" \
    ".bars{display:grid;grid-template-columns:6.5em 1fr;gap:.25em .5em;align-items:center;" \
    "font-size:13px}.name{font-weight:600}\n" \
    ".bar{display:flex;align-items:center;height:1.25em}.bar i{height:100%}" \
    ".bar i:first-child{border-radius:3px 0 0 3px}.bar b{font-weight:400;padding-left:.5em;" \
    "white-space:nowrap}\n" \
    ".legend{font-size:13px}.legend span{margin-right:1.2em;white-space:nowrap}.legend i{" \
    "display:inline-block;width:.9em;height:.9em;border-radius:2px;margin-right:.4em;" \
    "vertical-align:-.1em}\n" \
    ".p0{background:#5b6f8f}.p1{background:#a98b5d}.p2{background:#3f9a5c}.p3{background:#e0a83a}" \
    ".p4{background:#8e6bb8}.p5{background:#3fa3ad}.p6{background:#c9605d}.p7{background:#7d8a3d}" \
    ".p8{background:#b26a92}.p9{background:#8b9691}\n" \
    ".strip{display:grid;grid-template-columns:repeat(auto-fill,minmax(15em,1fr));gap:1.2em 1em;" \
    "margin:.8em 0}figure{margin:0}figure img{width:100%;display:block}\n" \
    "figure img:first-child{border-radius:6px 6px 0 0}figure img:last-of-type{" \
    "border-radius:0 0 6px 6px}figure img:only-of-type{border-radius:6px}" \
    "figcaption{font-size:13px;margin-top:.3em}\n" \
    ".legend .ramp{display:inline-block;width:9em;height:.8em;border-radius:2px;vertical-align:-.05em;" \
    "margin:0 .4em;background:linear-gradient(90deg,#000004,#51127c,#b73779,#fc8961,#fcfdbf)}\n"

#endif
