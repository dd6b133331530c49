import "./reset.css";
import "uplot/dist/uPlot.min.css";
import "./viewer.css";
import { openSource } from "./source";
import { Viewer } from "./viewer";

const root = document.getElementById("kavics-viewer");
if (root) {
  root.classList.add("kavics-viewer");
  const source = openSource();
  source.run().then((run) => new Viewer(root, source, run).start()).catch((error: unknown) => {
    root.textContent = `The results cannot be shown: ${(error as Error).message}`;
    root.setAttribute("role", "alert");
  });
}
