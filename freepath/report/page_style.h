#pragma once
/// @file How a page looks.

#include <string_view>

namespace freepath {

/// Colours, as declarations of variables.
inline constexpr std::string_view kPageLightColours =
    "--page:#f7f7f5;--card:#ffffff;--line:#e3e3de;--strong-line:#c9cac4;--ink:#1d2126;"
    "--soft:#5b6470;--accent:#2450c8;--tint:#e9eefc;--good:#006b49;--bad:#b3261e;--code:#f4f4f1;"
    "--shadow:0 1px 2px rgb(20 24 31/.05),0 6px 24px rgb(20 24 31/.045);color-scheme:light;";
inline constexpr std::string_view kPageDarkColours =
    "--page:#0f1114;--card:#16191d;--line:#282d34;--strong-line:#414852;--ink:#e6e9ed;"
    "--soft:#9ca5b1;--accent:#8ea8ff;--tint:#1e2846;--good:#40d69c;--bad:#ff8f85;--code:#1c2025;"
    "--shadow:none;color-scheme:dark;";
inline constexpr std::string_view kPagePrintColours =
    "--page:#ffffff;--card:#ffffff;--line:#d4d4d4;--strong-line:#808080;--ink:#000000;"
    "--soft:#333333;--accent:#000000;--tint:#eeeeee;--good:#000000;--bad:#000000;--code:#f4f4f4;"
    "--shadow:none;color-scheme:light;";

/// Everything else.
inline constexpr std::string_view kPageStyle = R"css(
*,*::before,*::after{box-sizing:border-box}
html{scroll-behavior:smooth;scroll-padding-top:4.5rem;-webkit-text-size-adjust:100%}
body{margin:0;background:var(--page);color:var(--ink);
  font:16px/1.6 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
a{color:var(--accent)}
button,select,input{font:inherit;color:inherit}
:focus-visible{outline:2px solid var(--accent);outline-offset:2px;border-radius:4px}
html:not(.js) .js-only{display:none!important}

/* The bar at the top: contents and theme. */
.bar{position:sticky;top:0;z-index:20;background:var(--page);border-bottom:1px solid var(--line)}
.bar-inner{max-width:1232px;margin:0 auto;padding:0 1rem;display:flex;align-items:center;
  gap:1rem;min-height:3.25rem}
.contents{flex:1;margin-left:-.7rem;min-width:0;overflow-x:auto;scrollbar-width:none;white-space:nowrap}
.contents::-webkit-scrollbar{display:none}
.contents ol{display:flex;gap:.25rem;list-style:none;margin:0;padding:.25rem 0}
.contents a{display:block;padding:.3rem .7rem;border-radius:999px;color:var(--soft);
  text-decoration:none;font-size:.875rem}
.contents a:hover{color:var(--ink);background:var(--line)}
.contents a[aria-current]{color:var(--accent);background:var(--tint);font-weight:600}
.button{display:inline-flex;align-items:center;justify-content:center;gap:.4rem;cursor:pointer;
  border:1px solid var(--line);background:var(--card);border-radius:8px;padding:.3rem .7rem;
  font-size:.8125rem;line-height:1.4;color:var(--soft);text-decoration:none;white-space:nowrap}
.button:hover{color:var(--ink);border-color:var(--strong-line)}
.theme svg{width:1em;height:1em;flex:none}

/* Text. */
main{max-width:1232px;margin:0 auto;padding:3rem 1rem 5rem}
.opening{margin:0 0 2.5rem}
h1{font-size:clamp(1.7rem,1.2rem + 2vw,2.5rem);line-height:1.15;letter-spacing:-.022em;
  font-weight:680;margin:0;overflow-wrap:anywhere;text-wrap:balance}
.subtitle{margin:.75rem 0 0;color:var(--soft);font-size:1.0625rem;max-width:75ch}
h2{font-size:1.375rem;line-height:1.25;letter-spacing:-.012em;font-weight:650;
  margin:3.25rem 0 1rem}
h2 a{color:inherit;text-decoration:none}
h2 a:hover::after{content:" #";color:var(--soft);font-weight:400}
.prose{max-width:75ch;margin:0 0 1.25rem}
.caption{margin:.85rem 0 0;color:var(--soft);font-size:.875rem;line-height:1.5;max-width:100ch}
figure{margin:0}
.card{background:var(--card);border:1px solid var(--line);border-radius:12px;
  padding:1.1rem 1.25rem;margin:0 0 1.25rem;box-shadow:var(--shadow);min-width:0}

/* Programs. */
.code{display:flex;align-items:flex-start;background:var(--code);padding:0;box-shadow:none}
.code{width:fit-content;max-width:100%}
.code pre{flex:0 1 auto;min-width:0;margin:0;padding:1rem 1.25rem;white-space:pre-wrap;
  overflow-wrap:anywhere;font:.8438rem/1.65 ui-monospace,SFMono-Regular,Menlo,Consolas,"DejaVu Sans Mono",monospace}
.code .button{margin:.6rem .6rem 0 0}

/* Tables. */
.table-card{padding:0;overflow:hidden}
.table-card .caption{padding:0 1.25rem 1rem}
.scroll{overflow-x:auto;overscroll-behavior-x:contain}
table{border-collapse:separate;border-spacing:0;width:100%;font-size:.8438rem;line-height:1.35;
  font-variant-numeric:tabular-nums}
th,td{padding:.5rem .65rem;border-bottom:1px solid var(--line);text-align:left;
  vertical-align:baseline;white-space:nowrap}
th:first-child,td:first-child{padding-left:1.25rem}
th:last-child,td:last-child{padding-right:1.25rem}
tbody tr:last-child td{border-bottom:0}
thead th{position:sticky;top:0;z-index:2;background:var(--card);vertical-align:bottom;
  border-bottom:1px solid var(--strong-line);font-weight:600;white-space:normal}
thead th:first-child,tbody td:first-child{position:sticky;left:0;background:var(--card)}
tbody td:first-child{z-index:1;font-weight:550}
thead th:first-child{z-index:3}
tbody tr:hover td{background:color-mix(in srgb,var(--ink) 4%,var(--card))}
.number{text-align:right}
th button{all:unset;cursor:pointer;display:inline;font-size:.8125rem;color:var(--soft)}
th button:hover,th[aria-sort] button{color:var(--ink)}
th button:focus-visible{outline:2px solid var(--accent);outline-offset:2px;border-radius:3px}
th[title] button{text-decoration:underline dotted;text-decoration-color:var(--strong-line);
  text-underline-offset:.25em}
th[aria-sort=ascending] button::after{content:" \2191"}
th[aria-sort=descending] button::after{content:" \2193"}
.note{display:block;color:var(--soft);font-size:.75rem;font-weight:400;margin-top:.1rem}
tbody td.best{color:var(--accent);font-weight:680}
tbody td.best,tbody tr:hover td.best{background:var(--tint)}
.good{color:var(--good);font-weight:550}
.bad{color:var(--bad);font-weight:550}
.faint{color:var(--soft);font-weight:400}

/* Where there is more to the side, that side has a shadow. */
.scroll,.drawing{--shade:rgb(0 0 0/.16);background:
  linear-gradient(90deg,var(--card) 40%,transparent) 0 0/3rem 100% local no-repeat,
  linear-gradient(270deg,var(--card) 40%,transparent) 100% 0/3rem 100% local no-repeat,
  linear-gradient(90deg,var(--shade),transparent) 0 0/.8rem 100% scroll no-repeat,
  linear-gradient(270deg,var(--shade),transparent) 100% 0/.8rem 100% scroll no-repeat}

/* Charts. */
.figures{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:1.25rem;margin:0 0 1.25rem}
.figures .card{margin:0;display:flex;flex-direction:column;padding:.6rem .6rem .8rem}
.figures .wide,.figures .card:only-child{grid-column:1/-1}
.drawing{overflow-x:auto}
.drawing>svg{display:block;width:100%;min-width:var(--least);max-width:var(--widest);height:auto;margin:0 auto}
.drawing .fpc-paper{display:none}
.drawing .fpc .fpc-halo{stroke:var(--card)!important}
.under{display:flex;gap:1rem;align-items:flex-start;justify-content:space-between;
  margin-top:auto;padding:.4rem .6rem 0}
.under .caption{margin:.25rem 0 0}
.save{flex:none;margin-left:auto}

/* Pictures. */
.tools{display:flex;flex-wrap:wrap;gap:.5rem 1rem;align-items:center;justify-content:space-between;
  margin-bottom:.9rem}
.tools>div{display:flex;flex-wrap:wrap;gap:.5rem;align-items:center}
.tools label{display:flex;align-items:center;gap:.45rem;font-size:.8125rem;color:var(--soft)}
.tools select{max-width:15rem;padding:.3rem .5rem;border:1px solid var(--line);border-radius:8px;
  background:var(--card);color:var(--ink)}
.tools .button{min-width:2.1rem}
.where,.scale-shown{font-size:.8125rem;color:var(--soft);min-width:3.6em;text-align:right;
  font-variant-numeric:tabular-nums}
.stage{position:relative;overflow:hidden;margin:0 auto;border-radius:6px;
  cursor:ew-resize;touch-action:pan-y;user-select:none;-webkit-user-select:none}
.stage.zoomed-in{cursor:grab;touch-action:none}
.stage.moving{cursor:grabbing}
.layer{position:absolute;inset:0}
.layer.left{clip-path:inset(0 calc(100% - var(--seam)) 0 0)}
.layer.right{clip-path:inset(0 0 0 var(--seam))}
.layer img{position:absolute;inset:0;width:100%;height:100%;transform-origin:0 0;
  image-rendering:pixelated;pointer-events:none}
.tag{position:absolute;top:.6rem;padding:.15rem .55rem;border-radius:999px;font-size:.75rem;
  max-width:45%;overflow:hidden;text-overflow:ellipsis;white-space:nowrap;
  background:rgb(12 14 17/.72);color:#fff;pointer-events:none}
.left .tag{left:.6rem}
.right .tag{right:.6rem}
.handle{position:absolute;top:0;bottom:0;left:var(--seam);width:2.25rem;margin-left:-1.125rem;
  cursor:ew-resize;touch-action:none}
.handle::before{content:"";position:absolute;top:0;bottom:0;left:50%;width:2px;margin-left:-1px;
  background:#fff;box-shadow:0 0 3px rgb(0 0 0/.7)}
.handle::after{content:"\2039\2002\203A";position:absolute;top:50%;left:50%;width:2rem;
  height:2rem;margin:-1rem 0 0 -1rem;border-radius:50%;background:#fff;color:#1d2126;
  font:700 .95rem/1.75rem system-ui,sans-serif;text-align:center;box-shadow:0 1px 5px rgb(0 0 0/.45)}
.seam{display:block;width:100%;margin:.75rem auto 0;accent-color:var(--accent)}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(15rem,100%),1fr));gap:1rem}
.grid figcaption{font-size:.8125rem;color:var(--soft);margin-top:.3rem;overflow-wrap:anywhere}
.grid img{display:block;width:100%;height:auto;border-radius:4px;background:#000}
.maps .grid{grid-template-columns:repeat(var(--columns),minmax(0,1fr))}
.maps .grid img,.enlarged img{image-rendering:pixelated}
.enlarge{all:unset;display:block;width:100%;cursor:zoom-in}
.enlarge:focus-visible{outline:2px solid var(--accent);outline-offset:2px}
html:not(.js) .enlarge{cursor:auto}
.colour-scale{max-width:34rem;margin:1.1rem auto 0}
.colour-scale img{display:block;width:100%;height:.8rem;border-radius:3px}
.colour-scale div{display:grid;grid-template-columns:1fr 1fr 1fr;font-size:.8125rem;
  color:var(--soft);margin-top:.3rem;font-variant-numeric:tabular-nums}
.colour-scale span:nth-child(2){text-align:center}
.colour-scale span:nth-child(3){text-align:right}
.enlarged{border:0;padding:0;background:none;max-width:96vw;max-height:96vh;color:#fff;
  cursor:zoom-out;overflow:hidden;outline:none}
.enlarged::backdrop{background:rgb(8 9 11/.94)}
.enlarged img{display:block;width:min(94vw,calc(86vh*var(--aspect)));height:auto;border-radius:4px}
.enlarged p{margin:.6rem 0 0;text-align:center;font-size:.9375rem}

@media screen{.js .picture-grid{display:none}}
@media (max-width:1000px){
  .figures{grid-template-columns:minmax(0,1fr)}
  .maps .grid{grid-template-columns:repeat(auto-fill,minmax(min(10rem,100%),1fr))}
}
/* A row of a wide table becomes a card, in which every value has its name. */
@media screen and (max-width:900px){
  .scroll{background:none}
  table.many,.many tbody,.many tr,.many td{display:block}
  .many thead{display:none}
  .many tr{padding:.7rem 1.25rem;border-bottom:1px solid var(--line)}
  .many tbody tr:last-child{border-bottom:0}
  .many td,.many td:first-child,.many td:last-child{display:flex;justify-content:space-between;
    gap:1rem;padding:.15rem 0;border:0;position:static;text-align:right;white-space:normal;
    overflow-wrap:anywhere}
  .many td::before{content:attr(data-label);color:var(--soft);font-weight:400;text-align:left;
    flex:none;max-width:50%}
  .many td:first-child{font-size:.9375rem;text-align:left}
  .many td:first-child::before{content:none}
  .many .note{display:inline;margin-left:.5em}
}
@media (max-width:600px){
  main{padding-top:2rem}
  .card{padding:.85rem}
  .table-card{padding:0}
  .code{padding:0}
  .figures .card{padding:.4rem .4rem .7rem}
  .tools label{flex:1 1 9rem}
  .tools select{flex:1;min-width:0}
  .tools>div{flex:1 1 100%}
}
@media (prefers-reduced-motion:reduce){html{scroll-behavior:auto}}
)css";

/// The style on paper: no controls, all pictures, nothing scrolls or is cut in two.
inline constexpr std::string_view kPagePrintStyle = R"css(
@page{size:A4;margin:13mm}
.bar,.tools,.stage,.seam,.button,.enlarged{display:none!important}
body{font-size:10pt;line-height:1.45}
main{max-width:none;padding:0}
.opening{margin-bottom:6mm}
h1{font-size:21pt}
h2{font-size:14pt;margin:8mm 0 3mm;break-after:avoid}
.subtitle{font-size:11pt}
.card{box-shadow:none;border-radius:0;border-color:var(--line);padding:3mm;margin-bottom:4mm;
  break-inside:avoid}
.code{border:1px solid var(--line)}
.code pre{padding:3mm;white-space:pre-wrap;overflow-wrap:anywhere;font-size:8.5pt}
.figures{gap:4mm;margin-bottom:4mm}
.figures .card{break-inside:avoid}
.drawing>svg{min-width:0;max-height:84mm}
.table-card{padding:0;border:0;overflow:visible;break-inside:auto}
.table-card .caption{padding:0}
.scroll,.drawing{overflow:visible;max-height:none;background:none}
table{font-size:min(8.5pt,84pt/var(--columns))}
th,td,thead th{white-space:normal;padding:1mm;position:static!important}
td.number{white-space:nowrap}
th:first-child,td:first-child{padding-left:0}
th:last-child,td:last-child{padding-right:0}
thead{display:table-header-group}
tr{break-inside:avoid}
th button{font-size:inherit;color:inherit;text-decoration:none!important}
.note{font-size:.88em}
.picture-grid{grid-template-columns:1fr 1fr!important}
.maps .grid{grid-template-columns:repeat(3,1fr)!important}
.grid figure{break-inside:avoid}
.viewer,.maps{break-inside:auto}
body,.card,td,img{-webkit-print-color-adjust:exact;print-color-adjust:exact}
)css";

}  // namespace freepath
