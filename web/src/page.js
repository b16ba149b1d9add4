// A page that carries its flights.
import uPlotStyle from "uplot/dist/uPlot.min.css";
import { energyCurve } from "./curves.js";
import { decoded } from "./data.js";
import { el } from "./dom.js";
import style from "./page.css";
import { Viewer } from "./viewer.js";

document.head.append(el("style", {}, uPlotStyle + style));
const data = decoded(JSON.parse(document.getElementById("data").textContent));
const viewer = new Viewer(document.getElementById("page"), data);
window.somersault = { viewer, energyCurve }; // for whoever looks with the browser's tools
