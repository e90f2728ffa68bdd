<?xml version="1.0"?>
<core:CityModel xmlns:core="c" xmlns:gml="g" xmlns:bldg="b" xmlns:xlink="x"><core:cityObjectMember>
<bldg:Building gml:id="B"><bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>
<gml:surfaceMember xlink:href="#roof"/><gml:surfaceMember><gml:Polygon gml:id="inner"><gml:exterior><gml:LinearRing><gml:posList>0 0 2 4 0 2 4 4 2 0 4 2 0 0 2</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember>
</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>
<bldg:boundedBy><bldg:RoofSurface><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:Polygon gml:id="roof"><gml:exterior><gml:LinearRing><gml:posList>0 0 3 4 0 3 4 4 3 0 4 3 0 0 3</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:RoofSurface></bldg:boundedBy></bldg:Building>
</core:cityObjectMember><core:cityObjectMember><frn:CityFurniture gml:id="A"><frn:lod2ImplicitRepresentation>
<core:ImplicitGeometry><core:transformationMatrix>2 0 0 7 0 2 0 0 0 0 2 0 0 0 0 1</core:transformationMatrix>
<core:relativeGMLGeometry><gml:Polygon gml:id="lamp"><gml:exterior><gml:LinearRing><gml:posList>0 0 0 4 0 0 4 4 0 0 4 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></core:relativeGMLGeometry>
<core:referencePoint><gml:Point><gml:pos>100 0 0</gml:pos></gml:Point></core:referencePoint>
</core:ImplicitGeometry></frn:lod2ImplicitRepresentation></frn:CityFurniture></core:cityObjectMember></core:CityModel>
