<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
  <context>
    <name>DelaunayMesher</name>
    <message>
      <source>Mesh this solid</source>
      <translation>Diesen Volumenkörper vernetzen</translation>
    </message>
    <message>
      <source>Tetrahedral FEM mesh of the selected solid, or of a closed mesh of triangles, by Delaunay refinement. It goes into the active analysis, if there is one</source>
      <translation>FEM-Netz aus Tetraedern für den gewählten Volumenkörper oder ein geschlossenes Netz aus Dreiecken durch Delaunay-Verfeinerung. Es kommt in die aktive Analyse, falls es eine gibt</translation>
    </message>
    <message>
      <source>Refine selected faces</source>
      <translation>Gewählte Flächen verfeinern</translation>
    </message>
    <message>
      <source>Smaller elements at the selected faces, edges or vertices of a part that has a mesh object</source>
      <translation>Kleinere Elemente an den gewählten Flächen, Kanten oder Ecken eines Teils, das ein Netzobjekt hat</translation>
    </message>
    <message>
      <source>Refine here</source>
      <translation>Hier verfeinern</translation>
    </message>
    <message>
      <source>Smaller elements inside a sphere, box or cylinder round the selected vertex, or where the part was clicked</source>
      <translation>Kleinere Elemente in einer Kugel, einem Quader oder einem Zylinder um die gewählte Ecke oder die angeklickte Stelle des Teils</translation>
    </message>
    <message>
      <source>Mesh group</source>
      <translation>Netzgruppe</translation>
    </message>
    <message>
      <source>A named group of the mesh at the selected faces, edges or vertices of a part that has a mesh object</source>
      <translation>Eine benannte Gruppe des Netzes an den gewählten Flächen, Kanten oder Ecken eines Teils, das ein Netzobjekt hat</translation>
    </message>
    <message>
      <source>Mesh quality</source>
      <translation>Netzqualität</translation>
    </message>
    <message>
      <source>Distribution of the dihedral angles and the worst elements of the selected mesh</source>
      <translation>Verteilung der Flächenwinkel und die schlechtesten Elemente des gewählten Netzes</translation>
    </message>
    <message>
      <source>Fix selected faces</source>
      <translation>Gewählte Flächen festhalten</translation>
    </message>
    <message>
      <source>A fixed constraint on the selected faces, edges or vertices. Without an active analysis one is made, with a solver, and steel as material</source>
      <translation>Feste Einspannung der gewählten Flächen, Kanten oder Ecken. Ohne aktive Analyse wird eine angelegt, mit Löser und Stahl als Werkstoff</translation>
    </message>
    <message>
      <source>Force on selected faces</source>
      <translation>Kraft auf gewählte Flächen</translation>
    </message>
    <message>
      <source>A force on the selected faces, edges or vertices. Without an active analysis one is made, with a solver, and steel as material</source>
      <translation>Kraft auf die gewählten Flächen, Kanten oder Ecken. Ohne aktive Analyse wird eine angelegt, mit Löser und Stahl als Werkstoff</translation>
    </message>
    <message>
      <source>Solve</source>
      <translation>Berechnen</translation>
    </message>
    <message>
      <source>Solve the analysis with CalculiX and show the stresses; meshes first if there is no mesh of the part and options as they are now</source>
      <translation>Die Analyse mit CalculiX berechnen und die Spannungen zeigen; vernetzt zuerst, wenn es kein Netz des Teils und der Optionen gibt, wie sie jetzt sind</translation>
    </message>
    <message>
      <source>Options</source>
      <translation>Optionen</translation>
    </message>
    <message>
      <source>FreeCAD</source>
      <translation>FreeCAD</translation>
    </message>
    <message>
      <source>Compiled part</source>
      <translation>Kompilierter Teil</translation>
    </message>
    <message>
      <source>Reading</source>
      <translation>Einlesen</translation>
    </message>
    <message>
      <source>Reading the shape</source>
      <translation>Form einlesen</translation>
    </message>
    <message>
      <source>Size field</source>
      <translation>Größenfeld</translation>
    </message>
    <message>
      <source>Curves</source>
      <translation>Kurven</translation>
    </message>
    <message>
      <source>Surfaces</source>
      <translation>Flächen</translation>
    </message>
    <message>
      <source>Boundary recovery</source>
      <translation>Rand herstellen</translation>
    </message>
    <message>
      <source>Refinement</source>
      <translation>Verfeinerung</translation>
    </message>
    <message>
      <source>Optimisation</source>
      <translation>Optimierung</translation>
    </message>
    <message>
      <source>Second order</source>
      <translation>Zweite Ordnung</translation>
    </message>
    <message>
      <source>Certificate</source>
      <translation>Nachweis</translation>
    </message>
    <message>
      <source>FEM mesh</source>
      <translation>FEM-Netz</translation>
    </message>
    <message>
      <source>Quality figures</source>
      <translation>Qualitätswerte</translation>
    </message>
    <message>
      <source>Triangulation</source>
      <translation>Triangulierung</translation>
    </message>
    <message>
      <source>Check of the mesh</source>
      <translation>Prüfung des Netzes</translation>
    </message>
    <message>
      <source>3D view</source>
      <translation>3D-Ansicht</translation>
    </message>
    <message>
      <source>CalculiX</source>
      <translation>CalculiX</translation>
    </message>
    <message>
      <source>%.4g to %.4g: %d elements</source>
      <translation>%.4g bis %.4g: %d Elemente</translation>
    </message>
    <message>
      <source>target %g°</source>
      <translation>Ziel %g°</translation>
    </message>
    <message>
      <source>The compiled part of Delaunay Mesher could not be loaded.</source>
      <translation>Der kompilierte Teil von Delaunay Mesher konnte nicht geladen werden.</translation>
    </message>
    <message>
      <source>On Debian, run in a terminal, then start FreeCAD again:</source>
      <translation>Unter Debian in einem Terminal ausführen, danach FreeCAD neu starten:</translation>
    </message>
    <message>
      <source>Elsewhere, with a Python of this version and a C++ compiler:</source>
      <translation>Sonst mit einem Python dieser Version und einem C++-Compiler:</translation>
    </message>
    <message>
      <source>This FreeCAD uses Python %s on %s %s; the part has to be made for it.</source>
      <translation>Dieses FreeCAD benutzt Python %s unter %s %s; der Teil muss dafür gebaut sein.</translation>
    </message>
    <message>
      <source>or without a compiler, with a wheel for this system instead of the last name: %s</source>
      <translation>oder ohne Compiler, mit einem Wheel für dieses System statt des letzten Namens: %s</translation>
    </message>
    <message>
      <source>Details: %s</source>
      <translation>Einzelheiten: %s</translation>
    </message>
    <message>
      <source>Fixed faces</source>
      <translation>Festgehaltene Flächen</translation>
    </message>
    <message>
      <source>Force on faces</source>
      <translation>Kraft auf Flächen</translation>
    </message>
    <message>
      <source>Steel (assumed)</source>
      <translation>Stahl (angenommen)</translation>
    </message>
    <message>
      <source>Select faces, edges or vertices of one part.</source>
      <translation>Wählen Sie Flächen, Kanten oder Ecken eines einzigen Teils.</translation>
    </message>
    <message>
      <source>FreeCAD cannot put loads and supports on links. Mesh and load a copy instead.</source>
      <translation>FreeCAD kann Lasten und Lager nicht auf Verknüpfungen setzen. Vernetzen und belasten Sie stattdessen eine Kopie.</translation>
    </message>
    <message>
      <source>Smallest dihedral angle</source>
      <translation>Kleinster Flächenwinkel</translation>
    </message>
    <message>
      <source>Largest dihedral angle</source>
      <translation>Größter Flächenwinkel</translation>
    </message>
    <message>
      <source>Radius ratio</source>
      <translation>Radienverhältnis</translation>
    </message>
    <message>
      <source>Radius-edge ratio</source>
      <translation>Verhältnis Umkugelradius zu Kante</translation>
    </message>
    <message>
      <source>Aspect ratio</source>
      <translation>Seitenverhältnis</translation>
    </message>
    <message>
      <source>Delaunay mesh run</source>
      <translation>Delaunay-Vernetzung</translation>
    </message>
    <message>
      <source>First (4 nodes)</source>
      <translation>Erste (4 Knoten)</translation>
    </message>
    <message>
      <source>Second (10 nodes)</source>
      <translation>Zweite (10 Knoten)</translation>
    </message>
    <message>
      <source>auto</source>
      <translation>auto</translation>
    </message>
    <message>
      <source>Chosen from the size of the part</source>
      <translation>Nach der Größe des Teils gewählt</translation>
    </message>
    <message>
      <source>automatic</source>
      <translation>automatisch</translation>
    </message>
    <message>
      <source>%s has no 3D view to draw into; open one in the menu View</source>
      <translation>%s hat keine 3D-Ansicht, in die gezeichnet werden könnte; im Menü Ansicht eine öffnen</translation>
    </message>
    <message>
      <source>General</source>
      <translation>Allgemein</translation>
    </message>
    <message>
      <source>Defaults of new meshes</source>
      <translation>Vorgaben für neue Netze</translation>
    </message>
    <message>
      <source>Colours</source>
      <translation>Farben</translation>
    </message>
    <message>
      <source>Bad elements</source>
      <translation>Schlechte Elemente</translation>
    </message>
    <message>
      <source>Good elements</source>
      <translation>Gute Elemente</translation>
    </message>
    <message>
      <source>Small sizes</source>
      <translation>Kleine Elementgrößen</translation>
    </message>
    <message>
      <source>Large sizes</source>
      <translation>Große Elementgrößen</translation>
    </message>
    <message>
      <source>Chosen element</source>
      <translation>Gewähltes Element</translation>
    </message>
    <message>
      <source>Mesh refinement</source>
      <translation>Netzverfeinerung</translation>
    </message>
    <message>
      <source>%s belongs to %s, one of %d meshes of this part; it can be dragged to another</source>
      <translation>%s gehört zu %s, einem von %d Netzen dieses Teils; es lässt sich auf ein anderes ziehen</translation>
    </message>
    <message>
      <source>Size region</source>
      <translation>Größenbereich</translation>
    </message>
    <message>
      <source>This part has no mesh object yet. Use 'Mesh this solid' first.</source>
      <translation>Dieses Teil hat noch kein Netzobjekt. Zuerst „Diesen Volumenkörper vernetzen“ benutzen.</translation>
    </message>
    <message>
      <source>Run</source>
      <translation>Lauf</translation>
    </message>
    <message>
      <source>Ready</source>
      <translation>Bereit</translation>
    </message>
    <message>
      <source>Messages of the mesher</source>
      <translation>Meldungen des Vernetzers</translation>
    </message>
    <message>
      <source>Mesh quality ...</source>
      <translation>Netzqualität ...</translation>
    </message>
    <message>
      <source>Results ...</source>
      <translation>Ergebnisse ...</translation>
    </message>
    <message>
      <source>Close this panel and open FreeCAD's own for the results</source>
      <translation>Dieses Fenster schließen und das von FreeCAD für die Ergebnisse öffnen</translation>
    </message>
    <message>
      <source>Mesh</source>
      <translation>Vernetzen</translation>
    </message>
    <message>
      <source>Cancel</source>
      <translation>Abbrechen</translation>
    </message>
    <message>
      <source>Failed; the old mesh was kept</source>
      <translation>Fehlgeschlagen; das alte Netz bleibt</translation>
    </message>
    <message>
      <source>Failed</source>
      <translation>Fehlgeschlagen</translation>
    </message>
    <message>
      <source>FreeCAD takes the mesh over ...</source>
      <translation>FreeCAD übernimmt das Netz ...</translation>
    </message>
    <message>
      <source>Done</source>
      <translation>Fertig</translation>
    </message>
    <message>
      <source>Solved</source>
      <translation>Berechnet</translation>
    </message>
    <message>
      <source>%s elements below %g°</source>
      <translation>%s Elemente unter %g°</translation>
    </message>
    <message>
      <source>none below %g°</source>
      <translation>keines unter %g°</translation>
    </message>
    <message>
      <source>&lt;b&gt;%s&lt;/b&gt; tetrahedra, &lt;b&gt;%s&lt;/b&gt; nodes</source>
      <translation>&lt;b&gt;%s&lt;/b&gt; Tetraeder, &lt;b&gt;%s&lt;/b&gt; Knoten</translation>
    </message>
    <message>
      <source>%.1f s</source>
      <translation>%.1f s</translation>
    </message>
    <message>
      <source>Cancelling ...</source>
      <translation>Wird abgebrochen ...</translation>
    </message>
    <message>
      <source>Cancelled</source>
      <translation>Abgebrochen</translation>
    </message>
    <message>
      <source>Not solved</source>
      <translation>Nicht berechnet</translation>
    </message>
    <message>
      <source>Largest displacement %.4g mm</source>
      <translation>Größte Verschiebung %.4g mm</translation>
    </message>
    <message>
      <source>Largest von Mises stress %.4g MPa (red)</source>
      <translation>Größte Vergleichsspannung (von Mises) %.4g MPa (rot)</translation>
    </message>
    <message>
      <source>Dihedral angles &lt;b&gt;%.1f°&lt;/b&gt; to &lt;b&gt;%.1f°&lt;/b&gt;, </source>
      <translation>Flächenwinkel &lt;b&gt;%.1f°&lt;/b&gt; bis &lt;b&gt;%.1f°&lt;/b&gt;, </translation>
    </message>
    <message>
      <source>Cancelled; the old mesh was kept</source>
      <translation>Abgebrochen; das alte Netz bleibt</translation>
    </message>
    <message>
      <source>Computing the sizes ...</source>
      <translation>Größen werden berechnet ...</translation>
    </message>
    <message>
      <source>About %s tetrahedra</source>
      <translation>Etwa %s Tetraeder</translation>
    </message>
    <message>
      <source>Results of CalculiX</source>
      <translation>Ergebnisse von CalculiX</translation>
    </message>
    <message>
      <source>Another task panel is open. Close it first.</source>
      <translation>Ein anderes Aufgabenfenster ist offen. Schließen Sie es zuerst.</translation>
    </message>
    <message>
      <source>Delaunay Mesher</source>
      <translation>Delaunay Mesher</translation>
    </message>
    <message>
      <source>Delaunay mesh</source>
      <translation>Delaunay-Netz</translation>
    </message>
    <message>
      <source>Preview sizes</source>
      <translation>Größenvorschau</translation>
    </message>
    <message>
      <source>Show on the part how large the elements will be, and estimate their number</source>
      <translation>Am Teil zeigen, wie groß die Elemente werden, und ihre Zahl schätzen</translation>
    </message>
    <message>
      <source>More options</source>
      <translation>Weitere Optionen</translation>
    </message>
    <message>
      <source>At least %s tetrahedra, more round curves and walls</source>
      <translation>Mindestens %s Tetraeder, an Rundungen und Wänden mehr</translation>
    </message>
    <message>
      <source>Mesh of %s</source>
      <translation>Netz von %s</translation>
    </message>
    <message>
      <source>acute angle of the part</source>
      <translation>spitzer Winkel des Teils</translation>
    </message>
    <message>
      <source>smallest size reached</source>
      <translation>kleinste Größe erreicht</translation>
    </message>
    <message>
      <source>no better place found</source>
      <translation>keine bessere Stelle gefunden</translation>
    </message>
    <message>
      <source>No cut</source>
      <translation>Kein Schnitt</translation>
    </message>
    <message>
      <source>Cut along X</source>
      <translation>Schnitt längs X</translation>
    </message>
    <message>
      <source>Cut along Y</source>
      <translation>Schnitt längs Y</translation>
    </message>
    <message>
      <source>Cut along Z</source>
      <translation>Schnitt längs Z</translation>
    </message>
    <message>
      <source>Export report ...</source>
      <translation>Bericht speichern ...</translation>
    </message>
    <message>
      <source>Worst elements</source>
      <translation>Schlechteste Elemente</translation>
    </message>
    <message>
      <source>Click a row to see the element</source>
      <translation>Eine Zeile anklicken, um das Element zu sehen</translation>
    </message>
    <message>
      <source>Look inside</source>
      <translation>Ins Innere sehen</translation>
    </message>
    <message>
      <source>Only below</source>
      <translation>Nur unter</translation>
    </message>
    <message>
      <source>%s elements shown</source>
      <translation>%s Elemente gezeigt</translation>
    </message>
    <message>
      <source>Save the report</source>
      <translation>Bericht speichern</translation>
    </message>
    <message>
      <source>no tetrahedra</source>
      <translation>keine Tetraeder</translation>
    </message>
    <message>
      <source>&lt;b&gt;%s&lt;/b&gt; elements, worst &lt;b&gt;%.4g%s&lt;/b&gt;</source>
      <translation>&lt;b&gt;%s&lt;/b&gt; Elemente, schlechtestes &lt;b&gt;%.4g%s&lt;/b&gt;</translation>
    </message>
    <message>
      <source>mean %.4g%s, the worst 5 %% beyond %.4g%s</source>
      <translation>Mittel %.4g%s, die schlechtesten 5 %% jenseits %.4g%s</translation>
    </message>
    <message>
      <source>Element</source>
      <translation>Element</translation>
    </message>
    <message>
      <source>Value</source>
      <translation>Wert</translation>
    </message>
    <message>
      <source>On</source>
      <translation>An</translation>
    </message>
    <message>
      <source>Reason</source>
      <translation>Grund</translation>
    </message>
    <message>
      <source>Only above</source>
      <translation>Nur über</translation>
    </message>
    <message>
      <source>inside</source>
      <translation>innen</translation>
    </message>
    <message>
      <source>The report was not saved: %s</source>
      <translation>Der Bericht wurde nicht gespeichert: %s</translation>
    </message>
    <message>
      <source>Sphere</source>
      <translation>Kugel</translation>
    </message>
    <message>
      <source>Box</source>
      <translation>Quader</translation>
    </message>
    <message>
      <source>Cylinder</source>
      <translation>Zylinder</translation>
    </message>
    <message>
      <source>Centre</source>
      <translation>Mittelpunkt</translation>
    </message>
    <message>
      <source>Radius</source>
      <translation>Radius</translation>
    </message>
    <message>
      <source>Corner</source>
      <translation>Ecke</translation>
    </message>
    <message>
      <source>Opposite corner</source>
      <translation>Gegenüberliegende Ecke</translation>
    </message>
    <message>
      <source>Start of the axis</source>
      <translation>Anfang der Achse</translation>
    </message>
    <message>
      <source>End of the axis</source>
      <translation>Ende der Achse</translation>
    </message>
    <message>
      <source>Size:</source>
      <translation>Größe:</translation>
    </message>
    <message>
      <source>Transition:</source>
      <translation>Übergang:</translation>
    </message>
    <message>
      <source>Kind:</source>
      <translation>Art:</translation>
    </message>
    <message>
      <source>These objects refer to the mesh and would lose it:</source>
      <translation>Diese Objekte beziehen sich auf das Netz und würden es verlieren:</translation>
    </message>
    <message>
      <source>Delete the mesh all the same?</source>
      <translation>Das Netz trotzdem löschen?</translation>
    </message>
    <message>
      <source>Edit mesh</source>
      <translation>Netz bearbeiten</translation>
    </message>
    <message>
      <source>Tetrahedral meshes of solids for finite element analysis</source>
      <translation>Tetraedernetze von Volumenkörpern für die Finite-Elemente-Analyse</translation>
    </message>
    <message>
      <source>&amp;Delaunay Mesher</source>
      <translation>&amp;Delaunay Mesher</translation>
    </message>
    <message>
      <source>Analysis</source>
      <translation>Analyse</translation>
    </message>
    <message>
      <source>Max size</source>
      <translation>Max. Größe</translation>
    </message>
    <message>
      <source>Largest edge length of the elements; automatic: 1/20 of the diagonal of the part</source>
      <translation>Größte Kantenlänge der Elemente; automatisch: 1/20 der Diagonale des Teils</translation>
    </message>
    <message>
      <source>Size</source>
      <translation>Größe</translation>
    </message>
    <message>
      <source>Min size</source>
      <translation>Min. Größe</translation>
    </message>
    <message>
      <source>Smallest edge length, given sizes included; automatic: 1/100 of Max size at curves, 1/50 at walls</source>
      <translation>Kleinste Kantenlänge, auch vorgegebener Größen; automatisch: 1/100 der maximalen Größe an Krümmungen, 1/50 an Wänden</translation>
    </message>
    <message>
      <source>Growth rate</source>
      <translation>Wachstumsrate</translation>
    </message>
    <message>
      <source>How fast the size may grow: mm of size per mm of distance</source>
      <translation>Wie schnell die Größe wachsen darf: mm Größe je mm Abstand</translation>
    </message>
    <message>
      <source>Elements per circle</source>
      <translation>Elemente je Kreis</translation>
    </message>
    <message>
      <source>Elements round a full circle of a curved face or edge; 0 ignores curvature</source>
      <translation>Elemente um einen vollen Kreis einer gekrümmten Fläche oder Kante; 0: Krümmung nicht beachten</translation>
    </message>
    <message>
      <source>Elements across walls</source>
      <translation>Elemente je Wanddicke</translation>
    </message>
    <message>
      <source>Elements across thin walls and narrow gaps; 0 ignores them</source>
      <translation>Elemente quer durch dünne Wände und enge Spalte; 0: nicht beachten</translation>
    </message>
    <message>
      <source>Element order</source>
      <translation>Elementordnung</translation>
    </message>
    <message>
      <source>1: straight elements with 4 nodes; 2: curved elements with 10 nodes</source>
      <translation>1: gerade Elemente mit 4 Knoten; 2: gekrümmte Elemente mit 10 Knoten</translation>
    </message>
    <message>
      <source>Elements</source>
      <translation>Elemente</translation>
    </message>
    <message>
      <source>Target angle</source>
      <translation>Zielwinkel</translation>
    </message>
    <message>
      <source>Smallest dihedral angle that the refinement aims at</source>
      <translation>Kleinster Flächenwinkel, den die Verfeinerung anstrebt</translation>
    </message>
    <message>
      <source>Optimise</source>
      <translation>Optimieren</translation>
    </message>
    <message>
      <source>Improve the elements after the refinement</source>
      <translation>Die Elemente nach der Verfeinerung verbessern</translation>
    </message>
    <message>
      <source>Seed</source>
      <translation>Startwert</translation>
    </message>
    <message>
      <source>Seed of the random numbers: the same seed gives the same mesh</source>
      <translation>Startwert der Zufallszahlen: gleicher Startwert, gleiches Netz</translation>
    </message>
    <message>
      <source>Threads</source>
      <translation>Threads</translation>
    </message>
    <message>
      <source>Threads; 0: all cores, at most 8. The mesh does not depend on it</source>
      <translation>Threads; 0: alle Kerne, höchstens 8. Das Netz hängt nicht davon ab</translation>
    </message>
    <message>
      <source>Max elements</source>
      <translation>Max. Elemente</translation>
    </message>
    <message>
      <source>No mesh when it would have more tetrahedra; 0: as many as fit into memory</source>
      <translation>Kein Netz, wenn es mehr Tetraeder hätte; 0: so viele, wie in den Speicher passen</translation>
    </message>
    <message>
      <source>Where the size holds: inside a sphere, a box or a cylinder</source>
      <translation>Wo die Größe gilt: in einer Kugel, einem Quader oder einem Zylinder</translation>
    </message>
    <message>
      <source>Centre of the sphere, corner of the box, start of the axis</source>
      <translation>Mittelpunkt der Kugel, Ecke des Quaders, Anfang der Achse</translation>
    </message>
    <message>
      <source>Opposite corner of the box, end of the axis</source>
      <translation>Gegenüberliegende Ecke des Quaders, Ende der Achse</translation>
    </message>
    <message>
      <source>Radius of the sphere or cylinder</source>
      <translation>Radius der Kugel oder des Zylinders</translation>
    </message>
    <message>
      <source>Largest edge length of the elements inside</source>
      <translation>Größte Kantenlänge der Elemente darin</translation>
    </message>
    <message>
      <source>Length outside over which the size grows to the one around; 0: by the growth rate of the mesh</source>
      <translation>Länge, über die die Größe außerhalb bis zu der der Umgebung wächst; 0: mit der Wachstumsrate des Netzes</translation>
    </message>
  </context>
</TS>
