"use strict";
(() => {
  const place = document.getElementById("kavics-viewer");
  fetch("data/run.json").then((answer) => answer.json()).then((run) => {
    place.textContent = `${run.title}: ${run.grains} grains, ${run.contacts} contacts, ${run.state}`;
  });
})();
